//! Where the coin is in the laboratory. The toss itself needs neither the horizontal position nor
//! the direction of the folded frame, so both are kept up to date for an observer only.

use crate::body::Units;
use crate::motion::{Motion, Spin};
use crate::series::sin_cos;
use coinmc_core::State;
use nalgebra::{UnitVector3, Vector3};

/// The folded frame in the laboratory, and the time since the launch in sqrt(D/g).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Place {
    /// Direction of the frame's x axis.
    heading: [f64; 2],
    /// Horizontal position of the coin's centre.
    position: [f64; 2],
    /// How high above the surface of the first landing the one is from which the coin's height counts.
    datum: f64,
    pub(crate) time: f64,
}

impl Place {
    /// At the origin at time 0, with the frame's x axis along `heading`.
    pub(crate) fn origin(heading: [f64; 2]) -> Self {
        Self {
            heading,
            position: [0.0; 2],
            datum: 0.0,
            time: 0.0,
        }
    }

    /// At `position` at time 0, with the frame's x axis along `heading`.
    pub(crate) fn at(position: [f64; 2], heading: [f64; 2]) -> Self {
        Self {
            heading,
            position,
            datum: 0.0,
            time: 0.0,
        }
    }

    /// The laboratory's components of a horizontal vector (`x`, `y`) in the frame.
    pub(crate) fn direction(&self, x: f64, y: f64) -> [f64; 2] {
        let [nx, ny] = self.heading;
        [nx * x - ny * y, nx * y + ny * x]
    }

    /// The horizontal place in the laboratory of a point at (`x`, `y`) from the centre, in the
    /// frame.
    pub(crate) fn point(&self, x: f64, y: f64) -> [f64; 2] {
        let [dx, dy] = self.direction(x, y);
        [self.position[0] + dx, self.position[1] + dy]
    }

    /// The components in the frame of a horizontal vector of the laboratory.
    pub(crate) fn in_frame(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [nx, ny] = self.heading;
        [nx * x + ny * y, nx * y - ny * x]
    }

    /// The way of the centre from an earlier place to this one, in the laboratory.
    pub(crate) fn way_from(&self, earlier: &Self) -> [f64; 2] {
        let (now, then) = (self.position, earlier.position);
        [now[0] - then[0], now[1] - then[1]]
    }

    /// The same place, with the centre elsewhere.
    pub(crate) fn with_centre_at(self, position: [f64; 2]) -> Self {
        Self { position, ..self }
    }

    /// Turns the frame so that its new x axis is (`nx`, `ny`) in the old frame.
    pub(crate) fn align(&mut self, nx: f64, ny: f64) {
        let [x, y] = self.heading;
        self.heading = [nx * x - ny * y, nx * y + ny * x];
    }

    /// Moves the coin by (`dx`, `dy`) in the frame.
    pub(crate) fn shift(&mut self, dx: f64, dy: f64) {
        let [x, y] = self.heading;
        self.position[0] += dx * x - dy * y;
        self.position[1] += dx * y + dy * x;
    }

    /// Counts heights from a surface that is lower by `by`: what is shown of the coin goes on from where it is.
    pub(crate) fn lower_datum(&mut self, by: f64) {
        self.datum -= by;
    }

    /// Follows a coin in contact for a time `h` within one integrator step. The frame turns at the
    /// rate of the azimuth, φ' = −ω_θ/s. Simpson's rule on the motions that `at` returns: fourth
    /// order.
    pub(crate) fn follow(&mut self, h: f64, at: impl Fn(f64) -> (Motion<f64>, Spin<f64>)) {
        let rates = |t: f64| {
            let (motion, spin) = at(t);
            ([motion.vx, motion.vy], -spin.turn / motion.sin)
        };
        let ((v0, w0), (v1, w1), (v2, w2)) = (rates(0.0), rates(0.5 * h), rates(h));
        // the parabola through the three rates, integrated to the middle and to the end
        let middle = sin_cos(h / 24.0 * (5.0 * w0 + 8.0 * w1 - w2));
        let end = sin_cos(h / 6.0 * (w0 + 4.0 * w1 + w2));
        let turned = |[x, y]: [f64; 2], (s, c): (f64, f64)| [x * c - y * s, x * s + y * c];
        let (v1, v2) = (turned(v1, middle), turned(v2, end));
        let [dx, dy] = std::array::from_fn(|i| h / 6.0 * (v0[i] + 4.0 * v1[i] + v2[i]));
        self.shift(dx, dy);
        self.align(end.1, end.0);
        self.time += h;
    }

    /// The state in SI units in the laboratory.
    pub(crate) fn state(
        &self,
        m: &Motion<f64>,
        spin: &Spin<f64>,
        heads_up: bool,
        units: &Units,
    ) -> State {
        let [x, y] = self.heading;
        let lab = |a: f64, b: f64, c: f64| Vector3::new(a * x - b * y, a * y + b * x, c);
        let up = lab(m.sin, 0.0, m.cos);
        let across = lab(m.cos, 0.0, -m.sin);
        let spin = up * spin.axial + across * spin.turn + lab(0.0, spin.tilt, 0.0);
        let axis = if heads_up { up } else { -up };
        let [px, py] = self.position;
        State {
            time_s: self.time * units.time_s,
            position_m: Vector3::new(px, py, m.z + self.datum) * units.length_m
                + Vector3::z() * units.rim_m,
            velocity_m_s: lab(m.vx, m.vy, m.vz) * units.speed_m_s(),
            axis: UnitVector3::new_unchecked(axis),
            spin_rad_s: spin / units.time_s,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_testkit::Dice;

    fn heading(angle: f64) -> [f64; 2] {
        [libm::cos(angle), libm::sin(angle)]
    }

    fn near(a: [f64; 2], b: [f64; 2], tolerance: f64) -> bool {
        (a[0] - b[0]).abs() < tolerance && (a[1] - b[1]).abs() < tolerance
    }

    /// The frame's axes in the laboratory are its heading, and that turned by a quarter to the
    /// left; two turns of the frame add up, and what is moved in it moves in the laboratory.
    #[test]
    fn the_frame_turns_and_moves_as_a_plane_does() {
        for toss in 0..100 {
            let mut dice = Dice::new(411, toss);
            let (first, second) = (dice.between(-3.0, 3.0), dice.between(-3.0, 3.0));
            let (x, y) = (dice.between(-1.0, 1.0), dice.between(-1.0, 1.0));
            let start = [dice.between(-1.0, 1.0), dice.between(-1.0, 1.0)];
            let mut place = Place::at(start, heading(first));
            let [nx, ny] = heading(second);
            place.align(nx, ny);
            let [cos, sin] = heading(first + second);
            let lab = [x * cos - y * sin, x * sin + y * cos];
            assert!(near(place.direction(x, y), lab, 1e-14));
            assert!(near(place.in_frame(lab), [x, y], 1e-14));
            let end = [start[0] + lab[0], start[1] + lab[1]];
            assert!(near(place.point(x, y), end, 1e-14));
            let before = place;
            place.shift(x, y);
            assert!(near(place.point(0.0, 0.0), end, 1e-14));
            assert!(near(place.way_from(&before), lab, 1e-14));
            let back = place.with_centre_at(start);
            assert!(near(back.way_from(&before), [0.0; 2], 1e-15));
        }
    }

    /// A coin that leans by 1 rad and whose frame turns at the rate 2 + cos t, going ahead at the
    /// speed 1 + t: its heading is 2t + sin t, its place the integral of its velocity (here by many
    /// small steps of the midpoint rule, to 1e-8). Half the step leaves a 16th of the error: the
    /// rule is of fourth order.
    #[test]
    fn a_place_follows_a_turning_coin_in_fourth_order() {
        let angle = |t: f64| 2.0 * t + libm::sin(t);
        let (sin, cos) = libm::sincos(1.0);
        let motion = |t: f64| {
            let motion = Motion {
                sin,
                cos,
                vx: -0.3,
                vy: 1.0 + t,
                ..Motion::still()
            };
            let spin = Spin {
                turn: -sin * (2.0 + libm::cos(t)),
                ..Spin::still()
            };
            (motion, spin)
        };
        let exact: [f64; 2] = {
            let count = 20_000;
            let h = 1.0 / f64::from(count);
            (0..count).fold([0.0; 2], |[x, y], i| {
                let t = (f64::from(i) + 0.5) * h;
                let [c, s] = heading(angle(t));
                let (vx, vy) = (-0.3, 1.0 + t);
                [x + h * (vx * c - vy * s), y + h * (vx * s + vy * c)]
            })
        };
        let errors = [8, 16].map(|steps| {
            let mut place = Place::origin([1.0, 0.0]);
            let h = 1.0 / f64::from(steps);
            for i in 0..steps {
                let begun = f64::from(i) * h;
                place.follow(h, |t| motion(begun + t));
            }
            assert!((place.time - 1.0).abs() < 1e-14);
            let [x, y] = place.position;
            let turned = place.in_frame(heading(angle(1.0)));
            let places = ((x - exact[0]).powi(2) + (y - exact[1]).powi(2)).sqrt();
            [places, turned[1].abs()]
        });
        for part in 0..2 {
            let ratio = errors[0][part] / errors[1][part];
            assert!((12.0..20.0).contains(&ratio), "{errors:?}");
        }
    }

    /// The state of a coin on its heading: u leans towards it, ω has the parts along u, along e_θ
    /// (across u, downwards) and along y, and a coin whose tails are up has the opposite axis.
    #[test]
    fn a_state_has_the_parts_of_its_motion() {
        let units = Units {
            length_m: 0.02,
            time_s: 0.05,
            rim_m: 0.001,
        };
        let mut dice = Dice::new(412, 0);
        for _ in 0..50 {
            let (lean, angle) = (dice.between(0.1, 3.0), dice.between(-3.0, 3.0));
            let mut between = || dice.between(-2.0, 2.0);
            let motion = Motion {
                sin: libm::sin(lean),
                cos: libm::cos(lean),
                vx: between(),
                vy: between(),
                vz: between(),
                z: between(),
                ..Motion::still()
            };
            let spin = Spin {
                axial: between(),
                turn: between(),
                tilt: between(),
            };
            let place = Place::at([between(), between()], heading(angle));
            let state = place.state(&motion, &spin, true, &units);
            let ahead = Vector3::new(libm::cos(angle), libm::sin(angle), 0.0);
            let left = Vector3::z().cross(&ahead);
            let u = ahead * motion.sin + Vector3::z() * motion.cos;
            let across = left.cross(&u);
            assert!((state.axis.into_inner() - u).norm() < 1e-14);
            let of_spin = [(u, spin.axial), (across, spin.turn), (left, spin.tilt)];
            for (direction, rate) in of_spin {
                assert!((state.spin_rad_s.dot(&direction) * 0.05 - rate).abs() < 1e-13);
            }
            let of_velocity = [
                (ahead, motion.vx),
                (left, motion.vy),
                (Vector3::z(), motion.vz),
            ];
            for (direction, speed) in of_velocity {
                assert!((state.velocity_m_s.dot(&direction) * 0.05 / 0.02 - speed).abs() < 1e-13);
            }
            let [px, py] = place.position;
            let at = Vector3::new(px, py, motion.z) * 0.02 + Vector3::new(0.0, 0.0, 0.001);
            assert!((state.position_m - at).norm() < 1e-15);
            let flipped = place.state(&motion, &spin, false, &units);
            assert_eq!(flipped.axis, -state.axis);
        }
    }

    /// What is shown of the height goes on where a coin's height counts from lower ground; so again from higher ground.
    #[test]
    fn heights_go_on_where_they_count_from_another_surface() {
        let coin = coinmc_core::Coin::cylinder(0.7, 0.01).expect("a valid coin");
        let surface = coinmc_core::Surface::new(0.5, 0.3).expect("a valid surface");
        let scene = coinmc_core::Scene::new(coin, surface, 9.81).expect("a valid scene");
        let units = Units::new(&scene);
        let mut place = Place::origin([1.0, 0.0]);
        let mut motion = Motion {
            sin: 1.0,
            z: 1.3,
            ..Motion::still()
        };
        let shown = |place: &Place, motion: &Motion<f64>| {
            let state = place.state(motion, &Spin::still(), true, &units);
            state.position_m.z / units.length_m
        };
        let before = shown(&place, &motion);
        for by in [0.2, -0.5] {
            place.lower_datum(by);
            motion.z += by;
            assert!((shown(&place, &motion) - before).abs() < 1e-12, "{by}");
        }
    }
}

//! One toss on its way: its state, its counters, and where it is for whoever watches.

use crate::body::{Body, Units};
use crate::contact::FLAT;
use crate::motion::{Motion, Spin};
use crate::observer_adapter::ObserverAdapter;
use crate::series::sin_cos;
use coinmc_core::{Decided, Ended, Face, Launch, Observer, State};
use nalgebra::{UnitVector3, Vector3};

/// Where the folded frame lies in the laboratory. Kept up only for an observer.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Place {
    /// The frame's x axis.
    heading: [f64; 2],
    position: [f64; 2],
    pub(crate) time: f64,
}

impl Place {
    /// The frame turned so that its x axis is (`nx`, `ny`) of the old one.
    pub(crate) fn align(&mut self, nx: f64, ny: f64) {
        let [x, y] = self.heading;
        self.heading = [nx * x - ny * y, nx * y + ny * x];
    }

    /// Displaced by (`dx`, `dy`) in the frame.
    pub(crate) fn shift(&mut self, dx: f64, dy: f64) {
        let [x, y] = self.heading;
        self.position[0] += dx * x - dy * y;
        self.position[1] += dx * y + dy * x;
    }

    /// Follows contact for a time `h`, within one step of its integrator: the frame turns with the
    /// azimuth, φ' = −ω_θ/s. Simpson's rule over the motions that `at` gives: of fourth order.
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
            position_m: Vector3::new(px, py, m.z) * units.length_m,
            velocity_m_s: lab(m.vx, m.vy, m.vz) * units.speed_m_s(),
            axis: UnitVector3::new_unchecked(axis),
            spin_rad_s: spin / units.time_s,
        }
    }
}

/// State and counters.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub(crate) struct Toss {
    pub(crate) impacts: u32,
    /// Impacts of one rim and the other, in turn, since the last flight.
    pub(crate) in_turn: u32,
    /// Whether u is up in the folded frame, −u otherwise.
    pub(crate) heads_up: bool,
    pub(crate) motion: Motion<f64>,
    pub(crate) spin: Spin<f64>,
    pub(crate) place: Place,
}

impl Toss {
    /// The motion of a coin in contact, and what shows it to an observer.
    #[inline]
    pub(crate) fn watched<'a, O: Observer>(
        &'a mut self,
        units: &'a Units,
        observer: &'a mut O,
    ) -> (
        &'a mut Motion<f64>,
        &'a mut Spin<f64>,
        ObserverAdapter<'a, O>,
    ) {
        let adapter = ObserverAdapter {
            observer,
            place: &mut self.place,
            heads_up: self.heads_up,
            units,
        };
        (&mut self.motion, &mut self.spin, adapter)
    }

    /// No toss yet.
    pub(crate) fn still() -> Self {
        Self {
            motion: Motion::still(),
            spin: Spin::still(),
            heads_up: true,
            impacts: 0,
            in_turn: 0,
            place: Place {
                heading: [1.0, 0.0],
                position: [0.0; 2],
                time: 0.0,
            },
        }
    }

    /// The launch in the folded frame. A coin that would begin inside the surface is lifted until
    /// it touches.
    pub(crate) fn new(launch: &Launch, units: &Units, body: &Body, axial_factor: f64) -> Self {
        let axis = launch.axis.into_inner();
        let heads_up = axis.z.is_sign_positive();
        // u and −u give the same vector, hence the same toss
        let up = if heads_up { axis } else { -axis };
        let across = (up.x * up.x + up.y * up.y).sqrt();
        let (nx, ny) = if across > 0.0 {
            (up.x / across, up.y / across)
        } else {
            (1.0, 0.0)
        };
        let along = |v: &Vector3<f64>, scale: f64| {
            (
                (v.x * nx + v.y * ny) / scale,
                (v.y * nx - v.x * ny) / scale,
                v.z / scale,
            )
        };
        let mut motion = Motion::still();
        motion.set_tilt(across, up.z);
        (motion.vx, motion.vy, motion.vz) = along(&launch.velocity_m_s, units.speed_m_s());
        let (wx, wy, wz) = along(&launch.spin_rad_s, 1.0 / units.time_s);
        let spin = Spin {
            axial: wx * motion.sin + wz * motion.cos,
            turn: wx * motion.cos - wz * motion.sin,
            tilt: wy,
        };
        motion.set_spin(&spin, axial_factor);
        motion.z = (launch.height_m / units.length_m).max(motion.rest_height(body));
        Self {
            motion,
            spin,
            heads_up,
            impacts: 0,
            in_turn: 0,
            place: Place {
                heading: [nx, ny],
                position: [0.0; 2],
                time: 0.0,
            },
        }
    }

    /// The face that is up.
    pub(crate) fn face(&self) -> Face {
        if self.heads_up {
            Face::Heads
        } else {
            Face::Tails
        }
    }

    /// The end of a toss that is decided.
    pub(crate) fn ended(&self, decided: Decided) -> Ended {
        Ended::Decided(if decided == Decided::Side {
            Face::Side
        } else {
            self.face()
        })
    }

    /// Whether the coin is all but level.
    pub(crate) fn is_level(&self) -> bool {
        self.motion.sin <= FLAT
    }

    /// For a coin that is all but level, every point of the lower rim is at the surface. Turns the
    /// frame to the one that is coming down: where u tilts to, u' = (ω_y, −ω_θ). Whether the coin
    /// is that level.
    pub(crate) fn level(&mut self, axial_factor: f64) -> bool {
        if !self.is_level() {
            return false;
        }
        let (x, y) = (self.spin.tilt, -self.spin.turn);
        let rate = (x * x + y * y).sqrt();
        if rate > 0.0 {
            self.motion.align(x / rate, y / rate);
            self.place.align(x / rate, y / rate);
            (self.spin.tilt, self.spin.turn) = (rate, 0.0);
            self.motion.set_spin(&self.spin, axial_factor);
        }
        true
    }

    /// The frame seen from the other face, for a coin on its side: the other rim becomes the
    /// lowest. There e_θ points down whichever way the frame looks.
    pub(crate) fn change_rim(&mut self) {
        self.motion.turn_frame();
        self.spin.tilt = -self.spin.tilt;
        self.spin.axial = -self.spin.axial;
        self.heads_up = !self.heads_up;
        self.place.align(-1.0, 0.0);
    }

    /// The state in SI units in the laboratory.
    pub(crate) fn state(&self, units: &Units) -> State {
        self.place
            .state(&self.motion, &self.spin, self.heads_up, units)
    }
}

//! The plane that touches the ground where a rim lands.
//!
//! A rim touches ground of the slopes (g_x, g_y) where it is parallel to it. That point is the rim's
//! lowest one as seen along the normal n = (−g_x, −g_y, 1)/sqrt(1 + g_x² + g_y²). So in axes of the
//! plane an impact is one with a level ground, under any law, and what it does to the energy, too.

use crate::motion::{LEAST_SIN, Motion, Spin};

type Vector = [f64; 3];

/// Axes whose z is a normal n of the ground, and whose x is along the part of u across n.
#[derive(Debug, Clone, Copy)]
pub(super) struct Incline {
    /// x, y and n in the coin's frame.
    axes: [Vector; 3],
    /// Sine and cosine of the tilt of u from n.
    tilt: [f64; 2],
    /// Cosine and sine of the angle about u by which e_θ and y of the coin's frame lie apart from those
    /// of these axes.
    turn: [f64; 2],
}

impl Incline {
    /// The plane with these slopes along x and y under a coin.
    pub(super) fn new(motion: &Motion<f64>, [gx, gy]: [f64; 2]) -> Self {
        let length = (1.0 + gx * gx + gy * gy).sqrt();
        let n = [-gx / length, -gy / length, 1.0 / length];
        let u = [motion.sin, 0.0, motion.cos];
        let cos = dot(&u, &n);
        let across: Vector = std::array::from_fn(|i| u[i] - cos * n[i]);
        let sin = dot(&across, &across).sqrt().max(LEAST_SIN);
        let x = across.map(|part| part / sin);
        let y = cross(&n, &x);
        let swing = [motion.cos, 0.0, -motion.sin];
        Self {
            axes: [x, y, n],
            tilt: [sin, cos],
            turn: [y[1], dot(&y, &swing)],
        }
    }

    /// A motion in these axes; its height stays as it is.
    pub(super) fn onto(
        &self,
        motion: &Motion<f64>,
        spin: &Spin<f64>,
        axial_factor: f64,
    ) -> (Motion<f64>, Spin<f64>) {
        let velocity = [motion.vx, motion.vy, motion.vz];
        let [vx, vy, vz] = self.axes.map(|axis| dot(&axis, &velocity));
        let [cos, sin] = self.turn;
        let spin = Spin {
            axial: spin.axial,
            turn: cos * spin.turn - sin * spin.tilt,
            tilt: sin * spin.turn + cos * spin.tilt,
        };
        let mut motion = Motion {
            sin: self.tilt[0],
            cos: self.tilt[1],
            vx,
            vy,
            vz,
            ..*motion
        };
        motion.set_spin(&spin, axial_factor);
        (motion, spin)
    }

    /// The velocities of a motion in these axes, for the coin that was at `before`.
    pub(super) fn back(
        &self,
        before: &Motion<f64>,
        (motion, spin): (&Motion<f64>, &Spin<f64>),
        axial_factor: f64,
    ) -> (Motion<f64>, Spin<f64>) {
        let [x, y, n] = &self.axes;
        let [vx, vy, vz] =
            std::array::from_fn(|i| x[i] * motion.vx + y[i] * motion.vy + n[i] * motion.vz);
        let [cos, sin] = self.turn;
        let spin = Spin {
            axial: spin.axial,
            turn: cos * spin.turn + sin * spin.tilt,
            tilt: cos * spin.tilt - sin * spin.turn,
        };
        let mut motion = Motion {
            vx,
            vy,
            vz,
            ..*before
        };
        motion.set_spin(&spin, axial_factor);
        (motion, spin)
    }
}

fn dot(a: &Vector, b: &Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: &Vector, b: &Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::Moreau;
    use crate::model::Model;
    use crate::settings::Settings;
    use coinmc_core::{Coin, Scene, Surface};
    use coinmc_testkit::Dice;
    use std::f64::consts::TAU;

    /// A motion, and its angular velocity in the coin's frame.
    fn motion(dice: &mut Dice) -> (Motion<f64>, Spin<f64>) {
        let angle = dice.between(0.2, 1.5);
        let spin = Spin {
            axial: dice.between(-3.0, 3.0),
            turn: dice.between(-3.0, 3.0),
            tilt: dice.between(-3.0, 3.0),
        };
        let motion = Motion {
            sin: libm::sin(angle),
            cos: libm::cos(angle),
            vx: dice.between(-1.0, 1.0),
            vy: dice.between(-1.0, 1.0),
            vz: dice.between(-3.0, -1.0),
            ..Motion::still()
        };
        (motion, spin)
    }

    fn velocity(motion: &Motion<f64>) -> Vector {
        [motion.vx, motion.vy, motion.vz]
    }

    /// The sum of its parts along u and across it, each times a factor.
    fn along_and_across(motion: &Motion<f64>, spin: &Spin<f64>, [a, t]: [f64; 2]) -> Vector {
        let (sin, cos) = (motion.sin, motion.cos);
        [
            a * spin.axial * sin + t * spin.turn * cos,
            t * spin.tilt,
            a * spin.axial * cos - t * spin.turn * sin,
        ]
    }

    /// The point of the lower rim, relative to the centre, that is lowest as seen along n: by trying many, to
    /// within some 1e-8, as the height there is flat.
    fn touching_point(motion: &Motion<f64>, [radius, half]: [f64; 2], n: &Vector) -> Vector {
        let (u, across) = (
            [motion.sin, 0.0, motion.cos],
            [motion.cos, 0.0, -motion.sin],
        );
        let point = |angle: f64| -> Vector {
            let (sin, cos) = libm::sincos(angle);
            let y = [0.0, 1.0, 0.0];
            std::array::from_fn(|i| radius * (cos * across[i] + sin * y[i]) - half * u[i])
        };
        let (mut middle, mut width) = (0.0, TAU);
        while width > 1e-9 {
            let best = (-500..=500)
                .map(|k| middle + width * f64::from(k) / 1000.0)
                .min_by(|a, b| dot(&point(*a), n).total_cmp(&dot(&point(*b), n)));
            middle = best.unwrap_or(middle);
            width *= 0.01;
        }
        point(middle)
    }

    /// Newton's and Coulomb's laws of an impact with a slope, in vectors: the impulse acts at the point of the
    /// rim that is lowest along the normal, changes the velocity there along the normal by its restitution, and
    /// takes energy; without friction it is along the normal.
    #[test]
    fn an_impact_is_one_with_the_plane_that_touches_the_ground() {
        let mut impacts = 0;
        for mu in [0.0, 0.3] {
            let surface = Surface::new(0.5, mu).expect("a valid surface");
            let coin = Coin::cylinder(0.6, 0.01).expect("a valid coin");
            let scene = Scene::new(coin, surface, 9.81).expect("a valid scene");
            let model = Model::new(&scene, &Settings::default(), Moreau).expect("valid settings");
            let (body, factor) = (model.dynamics.body, model.dynamics.axial_factor);
            for toss in 0..200 {
                let mut dice = Dice::new(315, toss);
                let (mut before, spin) = motion(&mut dice);
                before.set_spin(&spin, factor);
                let slopes = [dice.between(-0.2, 0.2), dice.between(-0.2, 0.2)];
                let incline = Incline::new(&before, slopes);
                let n = incline.axes[2];
                let touch = touching_point(&before, [body.radius, body.half], &n);
                let at_point = |motion: &Motion<f64>, spin: &Spin<f64>| {
                    let rotation = cross(&along_and_across(motion, spin, [1.0; 2]), &touch);
                    let of_centre = velocity(motion);
                    let there: Vector = std::array::from_fn(|i| of_centre[i] + rotation[i]);
                    dot(&there, &n)
                };
                let approach = -at_point(&before, &spin);
                // slow ones may stay
                if approach <= 0.5 {
                    continue;
                }
                impacts += 1;
                let (onto, turned) = incline.onto(&before, &spin, factor);
                let bounced = model.bounce(&onto, &turned, false);
                let (after, new) = incline.back(&before, (&bounced.motion, &bounced.spin), factor);

                let (old, now) = (velocity(&before), velocity(&after));
                let impulse: Vector = std::array::from_fn(|i| now[i] - old[i]);
                let moments = [body.ka, body.kt];
                let [had, has] = [(&before, &spin), (&after, &new)]
                    .map(|(motion, spin)| along_and_across(motion, spin, moments));
                let moment = cross(&touch, &impulse);
                for i in 0..3 {
                    let error = has[i] - had[i] - moment[i];
                    assert!(error.abs() < 1e-6, "{toss}: {error:e} along {i}");
                }
                let leaves = at_point(&after, &new);
                assert!((leaves - 0.5 * approach).abs() < 1e-6, "{toss}: {leaves}");
                assert!(after.kinetic(&body, &new) <= before.kinetic(&body, &spin));
                if mu == 0.0 {
                    let across = cross(&impulse, &n);
                    assert!(dot(&across, &across) < 1e-24, "{toss}: {across:?}");
                }
            }
        }
        assert!(impacts > 200, "{impacts}");
    }
}

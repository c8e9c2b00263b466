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

//! The six variables of contact in the triad that turns with the coin, from lab vectors.
//!
//! x is the unit horizontal projection of u, y = ẑ × x, u = s x + c ẑ and e_θ = c x − s ẑ.

use crate::newton_euler::{Rates, slip};
use crate::{Model, Motion};
use nalgebra::Vector3;

/// Tilt, angular velocities and slip in the triad, or the time derivatives of these.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Triad {
    /// θ, the angle of u from the vertical.
    pub tilt: f64,
    /// ω_y, which is θ'.
    pub rocking: f64,
    /// ω_a, about u.
    pub spin: f64,
    /// ω_θ, about e_θ.
    pub turn: f64,
    /// Slip of the contact point along x.
    pub slip_x: f64,
    /// Slip of the contact point along y.
    pub slip_y: f64,
}

/// The triad's variables of a motion in contact, and their derivatives: those of the lab vectors
/// and of the triad's own directions, by the product rule.
pub fn triad(model: &Model, motion: &Motion, rates: &Rates) -> (Triad, Triad) {
    let (u, w) = (motion.axis, motion.spin);
    let (s, c) = (motion.sine(), u.z);
    let s_rate = -c * rates.axis.z / s;
    let flat = |v: &Vector3<f64>| Vector3::new(v.x, v.y, 0.0);
    let x = flat(&u) / s;
    let x_rate = (flat(&rates.axis) - x * s_rate) / s;
    let (y, y_rate) = (Vector3::z().cross(&x), Vector3::z().cross(&x_rate));
    let theta = x * c - Vector3::z() * s;
    let theta_rate = x * rates.axis.z + x_rate * c - Vector3::z() * s_rate;
    let slip = slip(model, motion);
    let (slip, slip_rate) = (
        Vector3::new(slip.x, slip.y, 0.0),
        Vector3::new(rates.slip.x, rates.slip.y, 0.0),
    );
    let values = Triad {
        tilt: libm::atan2(s, c),
        rocking: w.dot(&y),
        spin: w.dot(&u),
        turn: w.dot(&theta),
        slip_x: slip.dot(&x),
        slip_y: slip.dot(&y),
    };
    let derivatives = Triad {
        tilt: -rates.axis.z / s,
        rocking: rates.spin.dot(&y) + w.dot(&y_rate),
        spin: rates.spin.dot(&u) + w.dot(&rates.axis),
        turn: rates.spin.dot(&theta) + w.dot(&theta_rate),
        slip_x: slip_rate.dot(&x) + slip.dot(&x_rate),
        slip_y: slip_rate.dot(&y) + slip.dot(&y_rate),
    };
    (values, derivatives)
}

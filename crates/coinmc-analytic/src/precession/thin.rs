//! The thin precessing coin, caught in the hand: how likely it shows the face it started with.
//!
//! # Derivation
//!
//! Heads shows if `cos²ψ + sin²ψ·cos φ > 0` (see [`precession`](super)), that is `cos φ > −cot²ψ`.
//! If `cot²ψ ≥ 1` this always holds. Otherwise, φ being uniform,
//!
//! > P(same) = (1/π)·acos(−cot²ψ) = ½ + (1/π)·asin(cot²ψ),  π/4 < ψ < 3π/4.
//!
//! With `c = cot²ψ` the half-angle formula `acos(−c) = 2 atan(sqrt((1 + c)/(1 − c)))` turns it into
//!
//! > P(same) = (2/π)·atan(1/sqrt(−cos 2ψ)),  P(other) = (2/π)·atan(sqrt(−cos 2ψ)),
//!
//! which keeps all digits where `asin` has its vertical tangent, at ψ = π/4.
//!
//! **Source.** P. Diaconis, S. Holmes and R. Montgomery, SIAM Review 49, 211 (2007).

use super::is_angle;
use std::f64::consts::{FRAC_2_PI, FRAC_PI_2};

/// Probability that the coin shows the face it started with, for the angle `psi_rad` in `[0, π]`
/// between its normal and its angular momentum: from ½ at π/2 to 1 at π/4 and beyond.
///
/// ```
/// use coinmc_analytic::precession::thin::p_same_side;
/// use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};
/// assert_eq!(p_same_side(FRAC_PI_2), 0.5);
/// assert_eq!(p_same_side(0.9 * FRAC_PI_4), 1.0);
/// assert!((p_same_side(80.99f64.to_radians()) - 0.508).abs() < 5e-6);
/// assert!(p_same_side(-0.1).is_nan());
/// ```
pub fn p_same_side(psi_rad: f64) -> f64 {
    match root_of_minus_cos_2psi(psi_rad) {
        Some(root) => FRAC_2_PI * libm::atan(1.0 / root),
        None => f64::NAN,
    }
}

/// Probability that the coin shows the other face, `1 − p_same_side` without its cancellation.
///
/// ```
/// use coinmc_analytic::precession::thin::p_other_side;
/// assert_eq!(p_other_side(0.5), 0.0);
/// assert_eq!(p_other_side(std::f64::consts::FRAC_PI_2), 0.5);
/// ```
pub fn p_other_side(psi_rad: f64) -> f64 {
    match root_of_minus_cos_2psi(psi_rad) {
        Some(root) => FRAC_2_PI * libm::atan(root),
        None => f64::NAN,
    }
}

/// The angle ψ, in `[π/4, π/2]`, at which the coin shows the face it started with at probability
/// `p_same_side`, in `[½, 1]`: `cot²ψ = sin(π(p − ½))`. At probability 1 every ψ ≤ π/4 is a
/// solution and π/4 is returned; below ½ there is none (NaN), because precession favours the face
/// that was up.
///
/// ```
/// use coinmc_analytic::precession::thin::psi_rad;
/// assert!((psi_rad(0.508).to_degrees() - 80.99).abs() < 0.005);
/// assert!(psi_rad(0.499).is_nan());
/// ```
pub fn psi_rad(p_same_side: f64) -> f64 {
    if !(0.5..=1.0).contains(&p_same_side) {
        return f64::NAN;
    }
    let excess = p_same_side - 0.5; // exact: both lie within a factor of two
    let cot_squared = libm::sin(FRAC_PI_2 * (2.0 * excess));
    FRAC_PI_2 - libm::atan(cot_squared.sqrt())
}

/// `sqrt(−cos 2ψ)`, or 0 where the heads face never looks down; `None` outside the domain.
fn root_of_minus_cos_2psi(psi_rad: f64) -> Option<f64> {
    is_angle(psi_rad).then(|| (-libm::cos(2.0 * psi_rad)).max(0.0).sqrt())
}

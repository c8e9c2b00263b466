//! Spherical-zone rule: a coin in any orientation in space that lands without a bounce.
//!
//! # Derivation
//!
//! Draw the sphere of radius `l` through both rims. The downward vertical through the centre meets
//! it in a point that is uniform on the sphere if the orientation is uniform on SO(3). An adhesive
//! landing (see the crate's overview) ends on the side if this point lies in the zone between the
//! rims. By Archimedes a zone of height `H` has the area
//!
//! > 2πl·H = πH·sqrt(4R² + H²),
//!
//! so that, of the whole area `4πl²`,
//!
//! > P(side) = H/(2l) = sin α = x/sqrt(x² + 4),  1 − P(side) = R²/(l(l + H/2)).
//!
//! **Small and large coins.** `x/2` as `x → 0`; `1 − 2/x²` as `x → ∞`.
//!
//! **Source.** F. Mosteller, *Fifty Challenging Problems in Probability with Solutions*
//! (Addison-Wesley, 1965), problem 38 "The thick coin": a third at `H = 0.354·2R`.

use crate::FaceProbabilities;
use crate::geometry::{
    checked_ratio, is_probability, one_minus_sin_alpha, ratio_of_alpha, sin_alpha,
};
use std::f64::consts::PI;

/// Probability of the side for `ratio = H/R` in `[0, +∞]`.
///
/// ```
/// use coinmc_analytic::zone;
/// assert!((zone::p_side(0.5f64.sqrt()) - 1.0 / 3.0).abs() < 1e-15);
/// assert!((1.0 / zone::p_side(0.184) - 11.0).abs() < 0.2); // a US nickel
/// ```
pub fn p_side(ratio: f64) -> f64 {
    probabilities(ratio).side
}

/// Probabilities of all faces for `ratio = H/R` in `[0, +∞]`.
///
/// ```
/// let p = coinmc_analytic::zone::probabilities(1.5); // a 3-4-5 triangle: sin α = 3/5
/// assert!((p.side - 0.6).abs() < 1e-15 && (p.heads - 0.2).abs() < 1e-15);
/// ```
pub fn probabilities(ratio: f64) -> FaceProbabilities {
    let Some(ratio) = checked_ratio(ratio) else {
        return FaceProbabilities::NAN;
    };
    FaceProbabilities::symmetric(sin_alpha(ratio), one_minus_sin_alpha(ratio))
}

/// Ratio `H/R` at which P(side) is `target`, in `[0, 1]`: `x = 2·target/sqrt(1 − target²)`.
///
/// ```
/// assert!((coinmc_analytic::zone::fair_ratio(0.6) - 1.5).abs() < 1e-15);
/// ```
pub fn fair_ratio(target: f64) -> f64 {
    if !is_probability(target) {
        return f64::NAN;
    }
    ratio_of_alpha(target, (1.0 - target) * (1.0 + target))
}

/// Area in square metres of the zone between the rims, `πH·sqrt(4R² + H²)`, on the sphere through
/// both, for a height and a radius in metres, neither negative.
///
/// ```
/// use coinmc_analytic::zone;
/// let l: f64 = 2.5e-3; // R = 2 mm, H = 3 mm
/// let share = zone::area_m2(3e-3, 2e-3) / (4.0 * std::f64::consts::PI * l * l);
/// assert!((share - zone::p_side(1.5)).abs() < 1e-15);
/// ```
pub fn area_m2(height_m: f64, radius_m: f64) -> f64 {
    if height_m >= 0.0 && radius_m >= 0.0 {
        PI * height_m * libm::hypot(2.0 * radius_m, height_m)
    } else {
        f64::NAN
    }
}

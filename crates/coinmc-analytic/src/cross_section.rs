//! Cross-section rule: the probability is proportional to the share of the outline of the axial
//! section.
//!
//! # Derivation
//!
//! Cut the coin by a plane through its axis: the section is a rectangle whose outline has two edges
//! of length `H` on the side and one of length `2R` on each face, so
//!
//! > P(side) = 2H/(2H + 4R) = x/(2 + x),  1 − P(side) = 2/(2 + x).
//!
//! It is [`surface_area`](crate::surface_area) in the plane: the probability that a random straight
//! line in the plane of a flat spin enters the section through its side. It has no basis in
//! mechanics.
//!
//! In a square section, `x = 2`, each of the four edges has a quarter, so the side has one half.
//! The folklore that a coin as high as it is wide is fair forgets that two of the edges are the
//! side.
//!
//! **Small and large coins.** `x/2` as `x → 0`; `1 − 2/x` as `x → ∞`.
//!
//! **Source.** Folklore, first author unknown.

use crate::FaceProbabilities;
use crate::geometry::{checked_ratio, is_probability};

/// Probability of the side for `ratio = H/R` in `[0, +∞]`.
///
/// ```
/// assert_eq!(coinmc_analytic::cross_section::p_side(2.0), 0.5);
/// ```
pub fn p_side(ratio: f64) -> f64 {
    probabilities(ratio).side
}

/// Probabilities of all faces for `ratio = H/R` in `[0, +∞]`.
///
/// ```
/// let p = coinmc_analytic::cross_section::probabilities(1.0);
/// assert!((p.side - p.heads).abs() < 1e-15); // the fair coin of this rule
/// ```
pub fn probabilities(ratio: f64) -> FaceProbabilities {
    let Some(ratio) = checked_ratio(ratio) else {
        return FaceProbabilities::NAN;
    };
    FaceProbabilities::from_weights(ratio, 2.0)
}

/// Ratio `H/R` at which P(side) is `target`, in `[0, 1]`: `x = 2·target/(1 − target)`.
///
/// ```
/// assert_eq!(coinmc_analytic::cross_section::fair_ratio(0.5), 2.0);
/// ```
pub fn fair_ratio(target: f64) -> f64 {
    if is_probability(target) {
        2.0 * target / (1.0 - target)
    } else {
        f64::NAN
    }
}

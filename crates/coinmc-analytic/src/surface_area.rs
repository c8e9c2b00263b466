//! Surface-area rule: the probability is proportional to the area.
//!
//! # Derivation
//!
//! The curved surface has the area `2πRH` and each face `πR²`, so
//!
//! > P(side) = 2πRH/(2πRH + 2πR²) = x/(1 + x),  1 − P(side) = 1/(1 + x).
//!
//! It has no basis in mechanics: by Cauchy's formula it is the probability that a straight line of
//! random direction and position enters the coin through its side. It is kept as the guess that a
//! theory has to beat; published tosses refute it.
//!
//! **Small and large coins.** `x` as `x → 0`; `1 − 1/x` as `x → ∞`.
//!
//! **Source.** Folklore, first author unknown; discussed as the equal-area argument wherever a fair
//! thick coin is.

use crate::FaceProbabilities;
use crate::geometry::{checked_ratio, is_probability};

/// Probability of the side for `ratio = H/R` in `[0, +∞]`.
///
/// ```
/// use coinmc_analytic::surface_area;
/// assert!((surface_area::p_side(0.5) - 1.0 / 3.0).abs() < 1e-15);
/// ```
pub fn p_side(ratio: f64) -> f64 {
    probabilities(ratio).side
}

/// Probabilities of all faces for `ratio = H/R` in `[0, +∞]`.
///
/// ```
/// let p = coinmc_analytic::surface_area::probabilities(1.0);
/// assert_eq!((p.heads, p.tails, p.side), (0.25, 0.25, 0.5));
/// ```
pub fn probabilities(ratio: f64) -> FaceProbabilities {
    let Some(ratio) = checked_ratio(ratio) else {
        return FaceProbabilities::NAN;
    };
    FaceProbabilities::from_weights(ratio, 1.0)
}

/// Ratio `H/R` at which P(side) is `target`, in `[0, 1]`: `x = target/(1 − target)`.
///
/// ```
/// assert_eq!(coinmc_analytic::surface_area::fair_ratio(0.75), 3.0);
/// ```
pub fn fair_ratio(target: f64) -> f64 {
    if is_probability(target) {
        target / (1.0 - target)
    } else {
        f64::NAN
    }
}

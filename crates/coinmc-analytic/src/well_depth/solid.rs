//! Well depth × solid angle, for a coin in space that bounces often. **A heuristic, unpublished.**
//!
//! # Derivation
//!
//! [`flat`](super::flat) with the angle of each well replaced by its solid angle: of the sphere of
//! directions of gravity the zone of the side takes the share `s = sin α` and the two caps of the
//! faces `1 − s` (see [`zone`](crate::zone)), so
//!
//! > P(side) = s(l − R)/[s(l − R) + (1 − s)(l − H/2)].
//!
//! Nobody has derived this weight or published a comparison with tosses. It is an interpolation
//! with the right limits, not a result.
//!
//! **Small and large coins.** `x³/16` as `x → 0`; `1 − 4/x⁴` as `x → ∞`.
//!
//! **Source.** None: the analogue in space of the rule of Pender and Uhrin (arXiv:1407.6307).

use super::odds::{Odds, solve};
use crate::FaceProbabilities;
use crate::geometry::{
    checked_ratio, face_well_depth, half_diagonal, is_probability, one_minus_sin_alpha,
    side_well_depth, sin_alpha,
};

/// Probability of the side for `ratio = H/R` in `[0, +∞]`.
///
/// ```
/// use coinmc_analytic::well_depth::solid;
/// // R = 4, H = 6, l = 5: the weights are 0.6·1 and 0.4·2.
/// assert!((solid::p_side(1.5) - 0.6 / 1.4).abs() < 1e-15);
/// ```
pub fn p_side(ratio: f64) -> f64 {
    probabilities(ratio).side
}

/// Probabilities of all faces for `ratio = H/R` in `[0, +∞]`.
///
/// ```
/// let p = coinmc_analytic::well_depth::solid::probabilities(0.0);
/// assert_eq!((p.heads, p.tails, p.side), (0.5, 0.5, 0.0));
/// ```
pub fn probabilities(ratio: f64) -> FaceProbabilities {
    let Some(ratio) = checked_ratio(ratio) else {
        return FaceProbabilities::NAN;
    };
    let (side, faces) = weights(ratio);
    FaceProbabilities::from_weights(side, faces)
}

/// Ratio `H/R` at which P(side) is `target`, in `[0, 1]`, by Newton's method.
///
/// ```
/// use coinmc_analytic::well_depth::solid;
/// assert!((solid::fair_ratio(1.0 / 3.0) - 1.3545).abs() < 5e-5);
/// assert_eq!(solid::fair_ratio(1.0), f64::INFINITY);
/// ```
pub fn fair_ratio(target: f64) -> f64 {
    if !is_probability(target) {
        return f64::NAN;
    }
    let target_odds = target / (1.0 - target);
    // the limits of the rule, x³/16 and x⁴/4
    let guess = if target <= 0.5 {
        libm::cbrt(16.0 * target_odds)
    } else {
        (4.0 * target_odds).sqrt().sqrt()
    };
    solve(target_odds, guess, odds)
}

fn weights(ratio: f64) -> (f64, f64) {
    let side = sin_alpha(ratio) * side_well_depth(ratio);
    let faces = one_minus_sin_alpha(ratio) * face_well_depth(ratio);
    (side, faces)
}

/// With `R = 1`, `s = sin α` and logarithmic derivatives in `x`: the depths give `1 + 1/l` and
/// `−s`, `s` gives `1/l²` and `1 − s` gives `−s(1 + s)`; and `1/l² + s² = 1`.
fn odds(ratio: f64) -> Odds {
    let (side, faces) = weights(ratio);
    let log_slope = 2.0 + 1.0 / half_diagonal(ratio) + 2.0 * sin_alpha(ratio);
    Odds {
        value: side / faces,
        log_slope,
    }
}

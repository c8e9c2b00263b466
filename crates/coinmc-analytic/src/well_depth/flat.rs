//! Well depth × angle, for a coin that spins about a horizontal diameter and bounces often.
//!
//! # Derivation
//!
//! Weigh each well by its depth times the angle it spans. Over one turn the two wells of the side
//! span `4α` and the wells of the faces `4(π/2 − α)`, so
//!
//! > P(side)/P(faces) = [(l − R)/(l − H/2)]·[α/(π/2 − α)].
//!
//! The weight is an assumption, not a theorem. It describes a coin that tips over its edges many
//! times while it loses energy slowly (bouncy or rough surfaces); its authors found real dice
//! nearer to even odds. The odds at `4/x` are the inverse of those at `x`: the section turned by a
//! right angle.
//!
//! **Small and large coins.** `x³/(8π)` as `x → 0`; `1 − 8/(πx³)` as `x → ∞`.
//!
//! **Source.** G. A. T. Pender and M. Uhrin, "Predicting non-square 2D dice probabilities",
//! arXiv:1407.6307 (2014), with a die of edges `k = 2R` and `l = H`.

use super::odds::{Odds, solve};
use crate::FaceProbabilities;
use crate::geometry::{
    checked_ratio, face_angle_rad, face_well_depth, half_diagonal, is_probability, side_angle_rad,
    side_well_depth, sin_alpha,
};
use std::f64::consts::PI;

/// Probability of the side for `ratio = H/R` in `[0, +∞]`.
///
/// ```
/// use coinmc_analytic::well_depth::flat;
/// assert!((flat::p_side(2.0) - 0.5).abs() < 1e-15);
/// let nickel = 1.95 / (0.5 * 21.21);
/// assert!((1.0 / flat::p_side(nickel) - 3491.0).abs() < 0.5);
/// ```
pub fn p_side(ratio: f64) -> f64 {
    probabilities(ratio).side
}

/// Probabilities of all faces for `ratio = H/R` in `[0, +∞]`.
///
/// ```
/// use coinmc_analytic::well_depth::flat;
/// let (wide, high) = (flat::probabilities(0.5), flat::probabilities(8.0));
/// assert!((wide.side - high.faces()).abs() < 1e-15); // 4/x swaps side and faces
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
/// use coinmc_analytic::well_depth::flat;
/// assert!((flat::fair_ratio(1.0 / 3.0) - 1.6570).abs() < 5e-5);
/// assert_eq!(flat::fair_ratio(0.0), 0.0);
/// ```
pub fn fair_ratio(target: f64) -> f64 {
    if !is_probability(target) {
        return f64::NAN;
    }
    let target_odds = target / (1.0 - target);
    // the limits of the rule, x³/(8π) and πx³/8
    let guess = if target <= 0.5 {
        libm::cbrt(8.0 * PI * target_odds)
    } else {
        libm::cbrt(8.0 / PI * target_odds)
    };
    solve(target_odds, guess, odds)
}

fn weights(ratio: f64) -> (f64, f64) {
    let side = side_well_depth(ratio) * side_angle_rad(ratio);
    let faces = face_well_depth(ratio) * face_angle_rad(ratio);
    (side, faces)
}

/// With `R = 1` and logarithmic derivatives in `x`: `l − R` gives `1 + 1/l`, `l − H/2` gives `−sin
/// α`, and `α` gives `(x/2)/(l²α)`, the other angle the same with the opposite sign.
fn odds(ratio: f64) -> Odds {
    let (side, faces) = weights(ratio);
    let l = half_diagonal(ratio);
    let turn = 0.5 * ratio / l / l;
    let angles = turn / side_angle_rad(ratio) + turn / face_angle_rad(ratio);
    Odds {
        value: side / faces,
        log_slope: 1.0 + 1.0 / l + sin_alpha(ratio) + angles,
    }
}

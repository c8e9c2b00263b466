//! Arc rule: a coin that spins about a horizontal diameter and lands without a bounce.
//!
//! # Derivation
//!
//! Seen along the spin axis the coin is a rectangle, `2R` by `H`. An adhesive landing (see the
//! crate's overview) puts it on the edge that the vertical line through the centre crosses. From
//! the centre each of the two edges of the side is seen under `2α` and each face under `π − 2α`.
//! With the landing angle uniform on the circle,
//!
//! > P(side) = 2·2α/(2π) = (2/π)·atan(x/2),  1 − P(side) = (2/π)·atan(2/x).
//!
//! The angle that matters is the one at the moment when the centre comes down to `l`: nothing
//! touches before, and afterwards the coin cannot pass a balance over a rim without touching first.
//! This angle is uniform if the angle at launch is uniform over whole turns, whatever the spin, and
//! in the limit of a vigorous toss, in which the coin turns often and the number of turns is not
//! controlled. (The angle *at contact* is not uniform for a coin that turns fast while it falls
//! slowly; the face is the same.)
//!
//! **Small and large coins.** `x/π` as `x → 0`; `1 − 4/(πx)` as `x → ∞`.
//!
//! **Source.** E. H. Yong and L. Mahadevan, "Probability, geometry, and dynamics in the toss of a
//! thick coin", Am. J. Phys. 79, 1195 (2011), the limit of a vigorous toss.

use crate::FaceProbabilities;
use crate::geometry::{
    checked_ratio, face_angle_rad, is_probability, side_angle_rad, sin_cos_quarter_turns,
};
use std::f64::consts::FRAC_2_PI;

/// Probability of the side for `ratio = H/R` in `[0, +∞]`.
///
/// ```
/// use coinmc_analytic::arc;
/// assert_eq!(arc::p_side(2.0), 0.5); // a square seen along its axis of spin
/// assert!((1.0 / arc::p_side(0.184) - 17.0).abs() < 0.2); // a US nickel
/// assert!(arc::p_side(-1.0).is_nan());
/// ```
pub fn p_side(ratio: f64) -> f64 {
    probabilities(ratio).side
}

/// Probabilities of all faces for `ratio = H/R` in `[0, +∞]`.
///
/// ```
/// let p = coinmc_analytic::arc::probabilities(f64::INFINITY);
/// assert_eq!((p.heads, p.tails, p.side), (0.0, 0.0, 1.0));
/// ```
pub fn probabilities(ratio: f64) -> FaceProbabilities {
    let Some(ratio) = checked_ratio(ratio) else {
        return FaceProbabilities::NAN;
    };
    FaceProbabilities::symmetric(
        FRAC_2_PI * side_angle_rad(ratio),
        FRAC_2_PI * face_angle_rad(ratio),
    )
}

/// Ratio `H/R` at which P(side) is `target`, in `[0, 1]`: `x = 2 tan(π·target/2)`.
///
/// ```
/// use coinmc_analytic::arc;
/// assert!((arc::fair_ratio(1.0 / 3.0) - 2.0 / 3f64.sqrt()).abs() < 1e-15);
/// assert_eq!(arc::fair_ratio(1.0), f64::INFINITY);
/// ```
pub fn fair_ratio(target: f64) -> f64 {
    if !is_probability(target) {
        return f64::NAN;
    }
    let (sin, cos) = sin_cos_quarter_turns(target);
    2.0 * sin / cos
}

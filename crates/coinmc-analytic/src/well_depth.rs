//! Well-depth rules: a coin that bounces often ends in a well of potential energy with a
//! probability that grows with the depth and the width of the well.
//!
//! # The wells
//!
//! A coin that touches the floor, its axis at the angle θ to the vertical, has its centre at the
//! height `R|sin θ| + (H/2)|cos θ|`. The minima are `H/2` (on a face) and `R` (on the side);
//! between them lies the barrier, the centre above the rim, at height `l`. In units of the weight,
//!
//! > depth of the side's well `l − R = (H²/4)/(l + R)`,  of a face's well `l − H/2 = R²/(l + H/2)`.
//!
//! | module | width of a well | status |
//! |---|---|---|
//! | [`flat`] | its angle: `α` for the side, `π/2 − α` for the faces | published |
//! | [`solid`] | its solid angle: `sin α` and `1 − sin α` | a heuristic, unpublished |
//!
//! The two functions below are in units of the radius; times `m·g·R` they are energies in joules.

use crate::geometry;

pub mod flat;
mod odds;
pub mod solid;

/// Height in radii by which the centre must rise to leave the side, `(l − R)/R`, for `ratio = H/R`
/// in `[0, +∞]`.
///
/// ```
/// use coinmc_analytic::well_depth::side_depth;
/// assert_eq!(side_depth(0.0), 0.0);
/// assert!((side_depth(1.5) - 0.25).abs() < 1e-15); // l = 5/4 of the radius
/// ```
pub fn side_depth(ratio: f64) -> f64 {
    geometry::checked_ratio(ratio).map_or(f64::NAN, geometry::side_well_depth)
}

/// Height in radii by which the centre must rise to leave a face, `(l − H/2)/R`, for `ratio = H/R`
/// in `[0, +∞]`.
///
/// ```
/// use coinmc_analytic::well_depth::face_depth;
/// assert_eq!(face_depth(0.0), 1.0);
/// assert!((face_depth(1.5) - 0.5).abs() < 1e-15);
/// ```
pub fn face_depth(ratio: f64) -> f64 {
    geometry::checked_ratio(ratio).map_or(f64::NAN, geometry::face_well_depth)
}

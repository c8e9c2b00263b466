//! Lengths (in radii) and angles of the coin without cancellation and with their limits at 0 and ∞,
//! and the domains that all rules share.

use std::f64::consts::FRAC_PI_2;

/// The ratio if it is in the domain of every rule, `[0, +∞]`; −0 becomes 0.
pub(crate) fn checked_ratio(ratio: f64) -> Option<f64> {
    (ratio >= 0.0).then_some(ratio.abs())
}

/// Whether `p` is a probability.
pub(crate) fn is_probability(p: f64) -> bool {
    (0.0..=1.0).contains(&p)
}

/// `l/R`.
pub(crate) fn half_diagonal(ratio: f64) -> f64 {
    libm::hypot(1.0, 0.5 * ratio)
}

/// `α = atan(x/2)`, the half-angle under which the side is seen from the centre.
pub(crate) fn side_angle_rad(ratio: f64) -> f64 {
    libm::atan(0.5 * ratio)
}

/// `π/2 − α = atan(2/x)`, the half-angle under which a face is seen from the centre.
pub(crate) fn face_angle_rad(ratio: f64) -> f64 {
    libm::atan(2.0 / ratio)
}

/// `sin α = x/sqrt(x² + 4)`. Above 2 both are divided by `x` first, because the
/// quotient of two large, nearly equal, rounded numbers may fall short of 1, and ∞/∞ is NaN.
pub(crate) fn sin_alpha(ratio: f64) -> f64 {
    if ratio < 2.0 {
        ratio / libm::hypot(ratio, 2.0)
    } else {
        1.0 / libm::hypot(1.0, 2.0 / ratio)
    }
}

/// `1 − sin α = 1/(l(l + H/2))` with `R = 1`, from `(l − H/2)(l + H/2) = 1`.
pub(crate) fn one_minus_sin_alpha(ratio: f64) -> f64 {
    face_well_depth(ratio) / half_diagonal(ratio)
}

/// `(l − R)/R`, from `(l − R)(l + R) = H²/4`; here `H²/4` is split as `(l sin α)(H/2)`, which keeps
/// the limit ∞.
pub(crate) fn side_well_depth(ratio: f64) -> f64 {
    sin_alpha(ratio) * (0.5 * ratio) / (1.0 + 1.0 / half_diagonal(ratio))
}

/// `(l − H/2)/R`, from `(l − H/2)(l + H/2) = R²`.
pub(crate) fn face_well_depth(ratio: f64) -> f64 {
    1.0 / (half_diagonal(ratio) + 0.5 * ratio)
}

/// `(sin(πp/2), cos(πp/2))`, each to full relative precision on all of `[0, 1]`: above one half
/// both come from `1 − p`, which is exact there.
pub(crate) fn sin_cos_quarter_turns(p: f64) -> (f64, f64) {
    if p <= 0.5 {
        (libm::sin(FRAC_PI_2 * p), libm::cos(FRAC_PI_2 * p))
    } else {
        (
            libm::cos(FRAC_PI_2 * (1.0 - p)),
            libm::sin(FRAC_PI_2 * (1.0 - p)),
        )
    }
}

/// Ratio of a coin with the given `sin α` and `1 − sin²α`: `x = 2 tan α`.
pub(crate) fn ratio_of_alpha(sin: f64, cos_squared: f64) -> f64 {
    2.0 * sin / cos_squared.sqrt()
}

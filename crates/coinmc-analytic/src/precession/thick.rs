//! The thick precessing coin with an adhesive landing: heads, tails and side.
//!
//! # Derivation
//!
//! With `s = sin α` and `C = cos 2ψ`, the coin rests on heads if `u_z > s` and on tails if
//! `u_z < −s`, where `u_z = cos²ψ + sin²ψ·cos φ` (see [`precession`](super), also for what is
//! assumed: heads up and level at the start, `L` fixed, φ uniform). With both arguments clipped to
//! `[−1, 1]`,
//!
//! > P(heads) = (1/π)·acos((s − cos²ψ)/sin²ψ),  P(tails) = 1 − (1/π)·acos((−s − cos²ψ)/sin²ψ).
//!
//! Let `2a` and `2b` be the two arc cosines. Half-angle formulas give, up to one common factor,
//!
//! > sin a : cos a = √(1 − s) : √(s − C),  sin b : cos b = √(1 + s) : √(−C − s),
//!
//! and the probabilities are `2a/π`, `1 − 2b/π` and, for the side, `2(b − a)/π`. The sine of the
//! difference, `sin b cos a − cos b sin a`, cancels for thin coins; multiplied by its own conjugate
//! it becomes
//!
//! > sin(b − a) : cos(b − a) = 4s·sin²ψ/[√((1 + s)(s − C)) + √((1 − s)(−C − s))] :
//! > √((−C − s)(s − C)) + √((1 − s)(1 + s)).
//!
//! # Where an outcome is out of reach
//!
//! * No tails if `s ≥ −C` (always so for ψ ≤ π/4): the coin never looks down far enough. Then
//!   P(side) = 1 − P(heads), and the tangent of half its angle is `√(s − C) : √(1 − s)`.
//! * Always heads if `s ≤ C` (only for ψ < π/4, or ψ > 3π/4): it never tips far enough.
//!
//! # The inverse
//!
//! Put `δ = π·P(side)/2`. While tails is within reach, sum and difference of the two arc cosines
//! give `s = tan δ·√(sin⁴ψ·cos²δ − cos⁴ψ)`; without tails `s = sin²δ + C·cos²δ`. They meet at
//! `cos²δ = cot²ψ`, where `s = −C`.
//!
//! **Reductions.** ψ = π/2 is the [arc rule](crate::arc); ratio 0 is the [thin coin](super::thin).
//!
//! **Source.** See [`precession`](super).

use super::is_angle;
use crate::FaceProbabilities;
use crate::geometry::{
    checked_ratio, is_probability, one_minus_sin_alpha, ratio_of_alpha, sin_alpha,
    sin_cos_quarter_turns,
};
use std::f64::consts::FRAC_2_PI;

/// Probabilities of all faces for `ratio = H/R` in `[0, +∞]` and the angle `psi_rad` in `[0, π]`
/// between the normal and the angular momentum. The coin starts heads up; had it started tails up,
/// swap the two.
///
/// ```
/// use coinmc_analytic::{arc, precession::thick};
/// use std::f64::consts::FRAC_PI_2;
/// let flip = thick::probabilities(1.0, FRAC_PI_2);
/// assert!((flip.side - arc::p_side(1.0)).abs() < 1e-15);
/// let wobble = thick::probabilities(1.0, 1.2);
/// assert!(wobble.heads > flip.heads && wobble.tails < flip.tails);
/// assert!(thick::probabilities(1.0, 4.0).side.is_nan());
/// ```
pub fn probabilities(ratio: f64, psi_rad: f64) -> FaceProbabilities {
    let Some(ratio) = checked_ratio(ratio).filter(|_| is_angle(psi_rad)) else {
        return FaceProbabilities::NAN;
    };
    let reach = Reach::of(ratio, &Precession::of(psi_rad));
    FaceProbabilities {
        heads: reach.heads(),
        tails: reach.tails(),
        side: reach.side(),
    }
}

/// Probability of the side for `ratio = H/R` in `[0, +∞]` and `psi_rad` in `[0, π]`.
///
/// ```
/// use coinmc_analytic::precession::thick;
/// assert_eq!(thick::p_side(0.1, 0.5), 0.0); // a thin coin that hardly tips stays heads
/// ```
pub fn p_side(ratio: f64, psi_rad: f64) -> f64 {
    probabilities(ratio, psi_rad).side
}

/// Ratio `H/R` at which P(side) is `target`, in `[0, 1]`, for `psi_rad` strictly between 0 and π.
///
/// It exists for every such target and angle: P(side) rises from 0 to 1 with the ratio. For ψ < π/4
/// or ψ > 3π/4 it stays 0 up to `x = 2 tan α` with `sin α = cos 2ψ`, and target 0 returns that
/// edge. At ψ = 0 and π the coin never tips, P(side) is 0 for every finite ratio, and the result is
/// NaN.
///
/// ```
/// use coinmc_analytic::precession::thick::fair_ratio;
/// for (psi_deg, fair) in [(90.0f64, 1.155), (80.0, 1.108), (70.0, 0.970), (60.0, 0.738)] {
///     assert!((fair_ratio(1.0 / 3.0, psi_deg.to_radians()) - fair).abs() < 5e-4);
/// }
/// assert!(fair_ratio(0.5, 0.0).is_nan());
/// ```
pub fn fair_ratio(target: f64, psi_rad: f64) -> f64 {
    let turns = is_angle(psi_rad) && psi_rad > 0.0 && psi_rad < std::f64::consts::PI;
    if !is_probability(target) || !turns {
        return f64::NAN;
    }
    let precession = Precession::of(psi_rad);
    let (sin, cos) = sin_cos_quarter_turns(target);
    if precession.has_tails(sin, cos) {
        ratio_with_tails(&precession, sin, cos)
    } else {
        ratio_without_tails(&precession, sin, cos)
    }
}

/// `s = tan δ·√(sin⁴ψ·cos²δ − cos⁴ψ)` and `1 − s² = cos²ψ(1 + sin²ψ) + sin⁴ψ·cos²δ + cos⁴ψ·tan²δ`.
fn ratio_with_tails(precession: &Precession, sin: f64, cos: f64) -> f64 {
    let Precession {
        sin_squared,
        cos_squared,
        cos_2psi,
    } = *precession;
    let tan = sin / cos;
    let root = if cos_2psi > -0.5 {
        // Near π/4 the two fourth powers nearly cancel; their difference at δ = 0 is −C.
        -cos_2psi - (sin_squared * sin) * (sin_squared * sin)
    } else {
        let [minus, plus] = precession.tails_factors(cos);
        minus * plus
    };
    let (p, q) = (sin_squared * cos, cos_squared * tan);
    let rest = cos_squared * (1.0 + sin_squared) + p * p + q * q;
    ratio_of_alpha(tan * root.sqrt(), rest)
}

/// `s = sin²δ + C·cos²δ` and `1 − s = 2 sin²ψ·cos²δ`.
fn ratio_without_tails(precession: &Precession, sin: f64, cos: f64) -> f64 {
    let one_minus_s = 2.0 * precession.sin_squared * cos * cos;
    let s = sin * sin + precession.cos_2psi * cos * cos;
    ratio_of_alpha(s, one_minus_s * (1.0 + s))
}

/// Functions of ψ, each correct to rounding.
struct Precession {
    sin_squared: f64,
    cos_squared: f64,
    cos_2psi: f64,
}

impl Precession {
    fn of(psi_rad: f64) -> Self {
        let (sin, cos) = (libm::sin(psi_rad), libm::cos(psi_rad));
        Self {
            sin_squared: sin * sin,
            cos_squared: cos * cos,
            cos_2psi: libm::cos(2.0 * psi_rad),
        }
    }

    /// Whether tails is within reach at the given δ: `sin²ψ·sin²δ < −C`, or the same in cosines
    /// where both sides of that are close to 1.
    fn has_tails(&self, sin_delta: f64, cos_delta: f64) -> bool {
        if self.cos_2psi > -0.5 {
            self.sin_squared * sin_delta * sin_delta < -self.cos_2psi
        } else {
            self.sin_squared * cos_delta * cos_delta > self.cos_squared
        }
    }

    /// The factors `sin²ψ·cos δ ∓ cos²ψ` of `sin⁴ψ·cos²δ − cos⁴ψ`.
    fn tails_factors(&self, cos_delta: f64) -> [f64; 2] {
        let p = self.sin_squared * cos_delta;
        [p - self.cos_squared, p + self.cos_squared]
    }
}

/// How far the normal reaches into each outcome: the terms under the roots of the derivation.
struct Reach {
    s: f64,
    one_minus_s: f64,
    sin_squared_psi: f64,
    /// `s − C`, not positive if the coin always shows heads.
    beyond_heads: f64,
    /// `−C − s`, not positive if the coin never shows tails.
    into_tails: f64,
}

impl Reach {
    /// The differences `s ∓ C` cancel near ±1; there they are computed from `1 − s` and `sin²ψ` or
    /// `cos²ψ`.
    fn of(ratio: f64, precession: &Precession) -> Self {
        let (s, one_minus_s) = (sin_alpha(ratio), one_minus_sin_alpha(ratio));
        let Precession {
            sin_squared,
            cos_squared,
            cos_2psi,
        } = *precession;
        let beyond_heads = if cos_2psi > 0.5 {
            2.0 * sin_squared - one_minus_s
        } else {
            s - cos_2psi
        };
        let into_tails = if cos_2psi < -0.5 {
            one_minus_s - 2.0 * cos_squared
        } else {
            -cos_2psi - s
        };
        Self {
            s,
            one_minus_s,
            sin_squared_psi: sin_squared,
            beyond_heads,
            into_tails,
        }
    }

    fn always_heads(&self) -> bool {
        self.beyond_heads <= 0.0
    }

    fn never_tails(&self) -> bool {
        self.into_tails <= 0.0
    }

    fn heads(&self) -> f64 {
        if self.always_heads() {
            return 1.0;
        }
        FRAC_2_PI * libm::atan2(self.one_minus_s.sqrt(), self.beyond_heads.sqrt())
    }

    fn tails(&self) -> f64 {
        if self.never_tails() {
            return 0.0;
        }
        FRAC_2_PI * libm::atan2(self.into_tails.sqrt(), (1.0 + self.s).sqrt())
    }

    fn side(&self) -> f64 {
        if self.always_heads() {
            return 0.0;
        }
        if self.never_tails() {
            return FRAC_2_PI * libm::atan2(self.beyond_heads.sqrt(), self.one_minus_s.sqrt());
        }
        let one_plus_s = 1.0 + self.s;
        let conjugate =
            (one_plus_s * self.beyond_heads).sqrt() + (self.one_minus_s * self.into_tails).sqrt();
        let sin = 4.0 * self.s * self.sin_squared_psi / conjugate;
        let cos =
            (self.into_tails * self.beyond_heads).sqrt() + (self.one_minus_s * one_plus_s).sqrt();
        FRAC_2_PI * libm::atan2(sin, cos)
    }
}

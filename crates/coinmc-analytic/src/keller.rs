//! Keller's bands: a thin coin tossed straight up, whose speed and spin decide the face.
//!
//! # Derivation
//!
//! The centre leaves with the upward speed `u` and the coin, heads up and level, spins at ω about a
//! horizontal diameter. It is back at its starting height after `T = 2u/g`, having made
//!
//! > `h = ωT/π = 2uω/(πg)` half-turns.
//!
//! Heads shows if the angle πh is within a quarter turn of a whole number of turns:
//!
//! > heads ⇔ `2n − ½ ≤ h ≤ 2n + ½` ⇔ `(2n − ½)πg/(2u) ≤ ω ≤ (2n + ½)πg/(2u)`,  n = 0, 1, 2, …
//!
//! For a coin that is caught at the height of its start this is all. It also holds for one that
//! starts with its centre one radius `R` above the floor and lands there without a bounce, touching
//! when its centre is at `R|sin ωt|`. Before `T` the centre is higher than `R` and the rim cannot
//! touch. After `T` it is lower than `R`, so the coin touches before it could stand upright, where
//! `|sin ωt| = 1`: between `T` and the contact the angle passes no odd quarter turn, so the face is
//! the same as at `T`.
//!
//! # Why a toss is fair
//!
//! In the plane of `u` and ω the bands are strips between hyperbolas, equally wide for heads and
//! tails and ever narrower towards large `uω`. [`p_heads_in_window`] is exact for a window of
//! half-turns of any width, and [`bias_bound`] says how fast any preference fades: as one over
//! twice the width.
//!
//! **Source.** J. B. Keller, "The probability of heads", Amer. Math. Monthly 93, 191 (1986). A
//! typical toss (u = 2.4 m/s, ω = 238.6 rad/s) makes about 37 half-turns.

use std::f64::consts::{FRAC_PI_2, PI};

/// Number of half-turns `2uω/(πg)` up to the return to the starting height.
///
/// The upward speed in metres per second is not negative, gravity in metres per second squared is
/// positive; the spin in radians per second may have either sign. NaN otherwise.
///
/// ```
/// use coinmc_analytic::keller::half_turns;
/// assert!((half_turns(2.4, 238.6, 9.81) - 37.16).abs() < 0.005);
/// assert!(half_turns(2.4, 238.6, 0.0).is_nan());
/// ```
pub fn half_turns(upward_speed_m_s: f64, spin_rad_s: f64, gravity_m_s2: f64) -> f64 {
    if upward_speed_m_s >= 0.0 && gravity_m_s2 > 0.0 {
        spin_rad_s * (upward_speed_m_s / (FRAC_PI_2 * gravity_m_s2))
    } else {
        f64::NAN
    }
}

/// Whether a coin that started heads up shows heads after so many half-turns, the edges of the
/// bands included. False for NaN and ±∞: no face is claimed for them.
///
/// ```
/// use coinmc_analytic::keller::is_heads;
/// assert!(is_heads(0.0) && is_heads(0.5) && is_heads(-37.7));
/// assert!(!is_heads(1.0) && !is_heads(37.0) && !is_heads(f64::NAN));
/// ```
pub fn is_heads(half_turns: f64) -> bool {
    from_whole_turn(half_turns).abs() <= 0.5
}

/// The spins between which a toss of a given speed shows heads after `n` whole turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeadsBand {
    /// Slowest spin of the band in radians per second; 0 for the band of no turn.
    pub slowest_rad_s: f64,
    /// Fastest spin of the band in radians per second.
    pub fastest_rad_s: f64,
}

impl HeadsBand {
    /// The band of `n` whole turns for an upward speed in metres per second, not negative, and a
    /// gravity in metres per second squared, positive; both edges are NaN otherwise.
    ///
    /// ```
    /// use coinmc_analytic::keller::HeadsBand;
    /// let band = HeadsBand::after_turns(19, 2.4, 9.81);
    /// assert!(238.6 < band.slowest_rad_s); // a typical toss turns less: tails
    /// assert_eq!(HeadsBand::after_turns(0, 2.4, 9.81).slowest_rad_s, 0.0);
    /// ```
    pub fn after_turns(n: u32, upward_speed_m_s: f64, gravity_m_s2: f64) -> Self {
        let half_turn_rad_s = if upward_speed_m_s >= 0.0 && gravity_m_s2 > 0.0 {
            PI * gravity_m_s2 / (2.0 * upward_speed_m_s)
        } else {
            f64::NAN
        };
        let middle = 2.0 * f64::from(n);
        let slowest = if n == 0 { 0.0 } else { middle - 0.5 };
        Self {
            slowest_rad_s: slowest * half_turn_rad_s,
            fastest_rad_s: (middle + 0.5) * half_turn_rad_s,
        }
    }
}

/// Probability of heads if the number of half-turns is uniform between two finite numbers.
///
/// As `h` is proportional to the spin and to the speed, this is a window in one of them with the
/// other fixed. Let `q(h)` be the surplus of heads, `∫(heads − ½)dh` from 0: a triangle wave
/// between ±¼ of period 2. Then P = ½ + (q(to) − q(from))/(to − from). A window of no width gives 1
/// or 0, one with its ends swapped gives NaN.
///
/// ```
/// use coinmc_analytic::keller::p_heads_in_window;
/// assert_eq!(p_heads_in_window(37.0, 39.0), 0.5); // one whole turn
/// assert_eq!(p_heads_in_window(37.25, 37.75), 0.5);
/// assert_eq!(p_heads_in_window(37.6, 38.4), 1.0);
/// ```
pub fn p_heads_in_window(from_half_turns: f64, to_half_turns: f64) -> f64 {
    let width = to_half_turns - from_half_turns;
    if !width.is_finite() || width < 0.0 {
        return f64::NAN;
    }
    if width == 0.0 {
        return f64::from(u8::from(is_heads(from_half_turns)));
    }
    // In [0, 1] without a clamp: each surplus is exact and rounding keeps order, so the rounded
    // difference is no larger than half the rounded width.
    let surplus = heads_surplus(to_half_turns) - heads_surplus(from_half_turns);
    0.5 + surplus / width
}

/// Largest possible |P(heads) − ½| for a window of the given width in half-turns: `min(½,
/// 1/(2·width))`, as the surplus of [`p_heads_in_window`] stays within ±¼. NaN for a negative
/// width.
///
/// ```
/// use coinmc_analytic::keller::bias_bound;
/// assert_eq!(bias_bound(0.0), 0.5);
/// assert_eq!(bias_bound(50.0), 0.01);
/// ```
pub fn bias_bound(width_half_turns: f64) -> f64 {
    if width_half_turns >= 0.0 {
        (0.5 / width_half_turns).min(0.5)
    } else {
        f64::NAN
    }
}

/// Half-turns past the nearest whole turn, in `[−1, 1]`. Exact: no operation rounds.
fn from_whole_turn(half_turns: f64) -> f64 {
    half_turns - 2.0 * (0.5 * half_turns).round()
}

/// `∫(heads − ½)dh` from 0 to `half_turns`.
fn heads_surplus(half_turns: f64) -> f64 {
    let past = from_whole_turn(half_turns);
    (0.5 * past.abs().min(1.0 - past.abs())).copysign(past)
}

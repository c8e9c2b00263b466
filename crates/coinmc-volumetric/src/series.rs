//! Elementary functions of the kernels, generic over lanes: sine and cosine, and the two functions
//! of linear drag. They use IEEE 754 operations only, so they are bit-identical on every platform.

use coinmc_lanes::{Lane, Mask, PI_2_TAIL, sin_cos_near_zero};
use std::f64::consts::{FRAC_2_PI, FRAC_PI_2, FRAC_PI_4};

/// (sin x, cos x) for any x, rad; within 4e-16 for |x| < 1e6. Beyond that, x itself is less precise
/// than the error of this function.
///
/// Cody & Waite reduction by multiples of π/2 in three parts of 33 bits, then the minimax
/// polynomials of FreeBSD's msun (`k_sin.c`, `k_cos.c`) on [−π/4, π/4].
#[inline(always)]
pub(crate) fn sin_cos<L: Lane>(x: L) -> (L, L) {
    const HIGH: f64 = 1.570_796_326_734_125_6;
    const MIDDLE: f64 = 6.077_100_506_303_966e-11;
    const LOW: f64 = 2.022_266_248_795_950_6e-21;
    let half = L::splat(0.5);
    let turns = (x * L::splat(FRAC_2_PI)).round();
    let y = ((x - turns * L::splat(HIGH)) - turns * L::splat(MIDDLE)) - turns * L::splat(LOW);
    let (s, c) = sin_cos_near_zero(y);
    // turns modulo 4: −2, −1, 0, 1 or 2
    let quarter = turns - (turns * L::splat(0.25)).round() * L::splat(4.0);
    let back = L::splat(1.5).lt(quarter.abs());
    let odd = half.lt(quarter.abs()) & !back;
    let sine = L::select(odd, c, s);
    let cosine = L::select(odd, s, c);
    (
        L::select(back | (odd & quarter.lt(-half)), -sine, sine),
        L::select(back | (odd & half.lt(quarter)), -cosine, cosine),
    )
}

/// (sin x, cos x) for a tilt, 0 <= x <= π/2 rad, within 4e-16; smooth, and accurate slightly
/// beyond.
#[inline(always)]
pub(crate) fn sin_cos_tilt<L: Lane>(x: L) -> (L, L) {
    let fold = L::splat(FRAC_PI_4).lt(x);
    let y = L::select(fold, (L::splat(FRAC_PI_2) - x) + L::splat(PI_2_TAIL), x);
    let (s, c) = sin_cos_near_zero(y);
    (L::select(fold, c, s), L::select(fold, s, c))
}

/// p = (1 − e^(−x))/x and q = (x − 1 + e^(−x))/x² for x >= 0. With linear drag k, in a time t a
/// velocity v₀ carries a body v₀ t·p(kt) far, and a unit force t²·q(kt). p(0) = 1, q(0) = ½.
#[inline(always)]
pub(crate) fn decay<L: Lane>(x: L) -> (L, L) {
    let one = L::splat(1.0);
    let small = x.lt(one);
    let q_small = series(x.min(one));
    let p_small = one - x * q_small;
    if !(!small).any() {
        return (p_small, q_small);
    }
    // beyond 64, e^(−x) is below the last bit of every number to which it is added
    let y = -x.min(L::splat(64.0)) * L::splat(1.0 / 64.0);
    let mut m = y * (one + y * series(-y));
    // e^(2y) − 1 = (e^y − 1)(e^y + 1), six times; the relative error does not grow for y < 0
    for _ in 0..6 {
        m *= m + L::splat(2.0);
    }
    let safe = x.max(L::splat(0.5));
    let (p, q) = (-m / safe, (safe + m) / (safe * safe));
    (L::select(small, p_small, p), L::select(small, q_small, q))
}

/// Σ (−x)ⁿ/(n + 2)! = q(x), accurate to the last bit for 0 <= x <= 1.
#[inline(always)]
fn series<L: Lane>(x: L) -> L {
    let mut sum = L::splat(0.0);
    for n in (0..17_u32).rev() {
        // Horner from the innermost term: 1/(n + 2)!·(…) as nested quotients of integers
        sum = (L::splat(1.0) - x * sum) * L::splat(1.0 / f64::from(n + 2));
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sine_and_cosine_agree_with_libm() {
        let mut worst: f64 = 0.0;
        for i in 0..2_000_000 {
            let x = (f64::from(i) - 1e6) * 0.731_234_567e-3 * 1.37;
            let (s, c) = sin_cos(x);
            worst = worst
                .max((s - libm::sin(x)).abs())
                .max((c - libm::cos(x)).abs());
        }
        for i in 0..100_000 {
            let x = f64::from(i) * 9.876_543_21;
            let (s, c) = sin_cos(x);
            worst = worst
                .max((s - libm::sin(x)).abs())
                .max((c - libm::cos(x)).abs());
        }
        assert!(worst <= 4e-16, "{worst:e}");
    }

    #[test]
    fn a_tilt_has_the_same_sine_and_cosine() {
        assert_eq!(sin_cos_tilt(0.0), (0.0, 1.0));
        for i in 0..=100_000 {
            let x = FRAC_PI_2 * f64::from(i) * 1e-5;
            let ((s, c), (sine, cosine)) = (sin_cos_tilt(x), (libm::sin(x), libm::cos(x)));
            assert!(
                (s - sine).abs() <= 4e-16 && (c - cosine).abs() <= 4e-16,
                "{x}"
            );
        }
    }

    #[test]
    fn drag_functions_agree_with_libm_and_with_no_drag() {
        assert_eq!(decay(0.0), (1.0, 0.5));
        for i in 1..100_000 {
            let x = f64::from(i) * 1e-3;
            let (p, q) = decay(x);
            let m = libm::expm1(-x);
            // six doublings and a quotient, each within half a unit in the last place
            assert!((p + m / x).abs() <= 1e-15 * p, "{x} {p}");
            // x + expm1(−x) cancels: below 1 only the identity x q + p = 1 is a fair test
            if x > 1.0 {
                assert!(
                    (q - (x + m) / (x * x)).abs() <= 1e-15 * q.max(1e-3),
                    "{x} {q}"
                );
            } else {
                assert!((1.0 - p - x * q).abs() <= 2.3e-16, "{x} {q}");
            }
        }
    }
}

//! Sine and cosine over lanes: [`coinmc_core::trig::sin_cos`] to the bit, lane by lane.

use coinmc_lanes::Lane;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

/// (sin x, cos x) for |x| <= π/2, rad, within 1.5 ulp.
///
/// Beyond π/4 the complement π/2 − |x| is evaluated and the two are exchanged, so that both stay
/// accurate where they vanish.
#[inline(always)]
pub(crate) fn sin_cos<L: Lane>(x: L) -> (L, L) {
    /// π/2 − FRAC_PI_2.
    const TAIL: f64 = 6.123_233_995_736_766e-17;
    let magnitude = x.abs();
    let fold = L::splat(FRAC_PI_4).lt(magnitude);
    let complement = (L::splat(FRAC_PI_2) - magnitude) + L::splat(TAIL);
    let (s, c) = near_zero(L::select(fold, complement, magnitude));
    (L::select(fold, c, s).copysign(x), L::select(fold, s, c))
}

/// (sin y, cos y) for 0 <= y <= π/4: the minimax polynomials of FreeBSD's msun.
#[inline(always)]
fn near_zero<L: Lane>(y: L) -> (L, L) {
    const S: [f64; 6] = [
        -1.666_666_666_666_663_2e-1,
        8.333_333_333_322_49e-3,
        -1.984_126_982_985_795e-4,
        2.755_731_370_707_007e-6,
        -2.505_076_025_340_686_3e-8,
        1.589_690_995_211_55e-10,
    ];
    const C: [f64; 6] = [
        4.166_666_666_666_66e-2,
        -1.388_888_888_887_411e-3,
        2.480_158_728_947_673e-5,
        -2.755_731_435_139_066_3e-7,
        2.087_572_321_298_175e-9,
        -1.135_964_755_778_819_5e-11,
    ];
    let k = L::splat;
    let z = y * y;
    let w = z * z;
    let sine_tail =
        k(S[0]) + z * (k(S[1]) + z * k(S[2])) + z * w * (k(S[3]) + z * (k(S[4]) + z * k(S[5])));
    let sine = y + y * z * sine_tail;
    let cosine_tail = z * (k(C[0]) + z * (k(C[1]) + z * k(C[2])))
        + w * w * (k(C[3]) + z * (k(C[4]) + z * k(C[5])));
    let half = k(0.5) * z;
    let head = k(1.0) - half;
    // (1 − head) − half is the rounding error of head, put back
    (sine, head + (((k(1.0) - head) - half) + z * cosine_tail))
}

/// The greatest integer that is not above x.
#[inline(always)]
pub(crate) fn floor<L: Lane>(x: L) -> L {
    // from 2^52 on all numbers are integers, so that adding it leaves no digits after the point
    let shift = L::splat(4_503_599_627_370_496.0);
    let size = x.abs();
    let near = ((size + shift) - shift).copysign(x);
    let near = L::select(size.lt(shift), near, x);
    L::select(x.lt(near), near - L::splat(1.0), near)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn has_the_bits_of_the_plain_one() {
        let n = 300_000;
        for i in 0..=n {
            let x = FRAC_PI_2 * (2.0 * f64::from(i) / f64::from(n) - 1.0);
            let ((s, c), (sine, cosine)) = (sin_cos(x), coinmc_core::trig::sin_cos(x));
            assert_eq!(
                (s.to_bits(), c.to_bits()),
                (sine.to_bits(), cosine.to_bits()),
                "{x}"
            );
        }
    }

    #[test]
    fn rounds_down() {
        for x in [
            -7.0, -2.5, -0.3, 0.0, 0.3, 0.5, 1.0, 1.5, 6.999, 1e12, -1e18,
        ] {
            assert_eq!(floor(x), f64::floor(x), "{x}");
        }
        assert!(floor(f64::NAN).is_nan());
    }
}

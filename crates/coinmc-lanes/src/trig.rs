//! Sine and cosine for the kernels: one implementation, bit-identical in every lane and on every
//! machine.
//!
//! It uses additions and multiplications only: no fused operations, no tables, no branches on the
//! value.

use crate::Lane;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

/// π/2 − FRAC_PI_2, the part of π/2 that an f64 cannot hold.
pub const PI_2_TAIL: f64 = 6.123_233_995_736_766e-17;

/// The polynomial P of sin y = y + y³ P(y²): the minimax polynomial of FreeBSD's msun (`k_sin.c`)
/// for |y| <= π/4, from the constant term up.
pub const SINE: [f64; 6] = [
    -1.666_666_666_666_663_2e-1,
    8.333_333_333_322_49e-3,
    -1.984_126_982_985_795e-4,
    2.755_731_370_707_007e-6,
    -2.505_076_025_340_686_3e-8,
    1.589_690_995_211_55e-10,
];

/// The polynomial P of cos y = 1 − y²/2 + y⁴ P(y²), likewise (`k_cos.c`).
pub const COSINE: [f64; 6] = [
    4.166_666_666_666_66e-2,
    -1.388_888_888_887_411e-3,
    2.480_158_728_947_673e-5,
    -2.755_731_435_139_066_3e-7,
    2.087_572_321_298_175e-9,
    -1.135_964_755_778_819_5e-11,
];

/// (sin x, cos x) for |x| <= π/2, in radians, within 1.5 ulp of the exact values.
///
/// Beyond π/4 the complement π/2 − |x| is evaluated and the two are exchanged, so that both stay
/// accurate where they vanish.
///
/// # Example
/// ```
/// let (s, c) = coinmc_lanes::sin_cos(0.5);
/// assert!((s - 0.479_425_538_604_203_f64).abs() < 1e-15 && (c - 0.877_582_561_890_372_8_f64).abs() < 1e-15);
/// ```
#[inline(always)]
pub fn sin_cos<L: Lane>(x: L) -> (L, L) {
    let magnitude = x.abs();
    let fold = L::splat(FRAC_PI_4).lt(magnitude);
    let complement = (L::splat(FRAC_PI_2) - magnitude) + L::splat(PI_2_TAIL);
    let (s, c) = sin_cos_near_zero(L::select(fold, complement, magnitude));
    (L::select(fold, c, s).copysign(x), L::select(fold, s, c))
}

/// (sin y, cos y) for |y| <= π/4, rad: the minimax polynomials of FreeBSD's msun ([`SINE`],
/// [`COSINE`]; S. Moshier / Sun Microsystems 1993).
#[inline(always)]
pub fn sin_cos_near_zero<L: Lane>(y: L) -> (L, L) {
    let ([s1, s2, s3, s4, s5, s6], [c1, c2, c3, c4, c5, c6]) = (SINE, COSINE);
    let k = L::splat;
    let z = y * y;
    let w = z * z;
    let sine_tail = k(s1) + z * (k(s2) + z * k(s3)) + z * w * (k(s4) + z * (k(s5) + z * k(s6)));
    let sine = y + y * z * sine_tail;
    let cosine_tail =
        z * (k(c1) + z * (k(c2) + z * k(c3))) + w * w * (k(c4) + z * (k(c5) + z * k(c6)));
    let half = k(0.5) * z;
    let head = k(1.0) - half;
    // (1 − head) − half is the rounding error of head, added back
    (sine, head + (((k(1.0) - head) - half) + z * cosine_tail))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Block, Lanes, WIDTH, Wide, Work};

    fn ulps(a: f64, b: f64) -> f64 {
        (a - b).abs() / (b.abs() * f64::EPSILON).max(f64::MIN_POSITIVE)
    }

    /// libm's sin and cos are within 1 ulp and these within 1.5, together 2.5. The unit here,
    /// EPSILON·|b|, is at least half an ulp.
    #[test]
    fn agrees_with_libm_on_its_whole_domain() {
        // Miri is some thousand times slower
        let n = if cfg!(miri) { 2_000 } else { 2_000_000 };
        let mut worst: f64 = 0.0;
        for i in 0..=n {
            let x = FRAC_PI_2 * (2.0 * f64::from(i) / f64::from(n) - 1.0);
            let (s, c) = sin_cos(x);
            worst = worst.max(ulps(s, libm::sin(x))).max(ulps(c, libm::cos(x)));
        }
        assert!(worst <= 2.5, "{worst}");
    }

    struct Both<'a>(&'a Block, &'a mut [Block; 2]);

    impl Work for Both<'_> {
        type Output = ();

        #[inline(always)]
        fn run<L: Wide>(self) {
            let (s, c) = sin_cos(L::load(self.0));
            *self.1 = [s.store(), c.store()];
        }
    }

    #[test]
    fn every_lane_is_bit_identical_to_the_scalar_path() {
        let n = if cfg!(miri) { 300 } else { 300_000 };
        let at = |i: usize| FRAC_PI_2 * (2.0 * i as f64 / n as f64 - 1.0);
        for lanes in Lanes::wide() {
            for start in (0..=n).step_by(WIDTH) {
                let block: Block = std::array::from_fn(|i| at((start + i).min(n)));
                let mut found = [[0.0; WIDTH]; 2];
                lanes.enter(Both(&block, &mut found));
                for (i, &x) in block.iter().enumerate() {
                    let (sine, cosine) = sin_cos(x);
                    let bits = [found[0][i], found[1][i]].map(f64::to_bits);
                    assert_eq!(bits, [sine, cosine].map(f64::to_bits), "{lanes} {x}");
                }
            }
        }
    }

    #[test]
    fn is_exact_at_zero_and_a_right_angle_and_odd() {
        assert_eq!(sin_cos(0.0), (0.0, 1.0));
        let (s, c) = sin_cos(FRAC_PI_2);
        assert_eq!(s, 1.0);
        assert_eq!(c, PI_2_TAIL);
        for i in 0..1000 {
            let x = f64::from(i) * 1.57e-3;
            let ((s, c), (ms, mc)) = (sin_cos(x), sin_cos(-x));
            assert_eq!((s, c), (-ms, mc));
        }
    }
}

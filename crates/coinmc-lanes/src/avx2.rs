//! Eight lanes in two registers of AVX2: one works while the other waits for a root or a quotient.
//!
//! # Safety
//! As in `avx512`: values exist only inside [`enter`], which checks the processor first.
#![allow(unsafe_code)]

use crate::operators::{by_permutation, operators};
use crate::wide::{Bits, Block, WIDTH, Wide, Work, map_where};
use crate::{Lane, Mask, Route};
use std::arch::x86_64::{
    __m256d, __m256i, _CMP_LE_OQ, _CMP_LT_OQ, _mm256_add_pd, _mm256_and_pd, _mm256_and_si256,
    _mm256_andnot_pd, _mm256_blendv_pd, _mm256_castpd_ps, _mm256_castps_pd, _mm256_castsi256_pd,
    _mm256_cmp_pd, _mm256_cmpeq_epi64, _mm256_div_pd, _mm256_loadu_pd, _mm256_max_pd,
    _mm256_min_pd, _mm256_movemask_pd, _mm256_mul_pd, _mm256_or_pd, _mm256_permutevar8x32_ps,
    _mm256_set_epi64x, _mm256_set1_epi64x, _mm256_set1_pd, _mm256_setr_epi32, _mm256_sqrt_pd,
    _mm256_storeu_pd, _mm256_sub_pd, _mm256_xor_pd,
};
use std::sync::LazyLock;

#[derive(Debug, Clone, Copy)]
pub(crate) struct Eight(__m256d, __m256d);

/// All bits of a lane set, or none of them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct EightBits(__m256d, __m256d);

/// Whether the processor has all features that [`enter`] uses, as every one by Intel or AMD with
/// AVX2 does.
#[inline]
pub(crate) fn is_available() -> bool {
    static IS_AVAILABLE: LazyLock<bool> = LazyLock::new(|| {
        is_x86_feature_detected!("avx2")
            && is_x86_feature_detected!("bmi1")
            && is_x86_feature_detected!("bmi2")
            && is_x86_feature_detected!("lzcnt")
            && is_x86_feature_detected!("popcnt")
    });
    *IS_AVAILABLE
}

/// Runs the work with these lanes; `None` if the processor does not support them.
#[inline]
pub(crate) fn enter<W: Work>(work: W) -> Option<W::Output> {
    // beside AVX2 itself, features with which the compiler makes faster code
    #[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt")]
    fn inside<W: Work>(work: W) -> W::Output {
        work.run::<Eight>()
    }
    // SAFETY: the processor has all of the features.
    is_available().then(|| unsafe { inside(work) })
}

/// Methods of one instruction per half.
macro_rules! instructions {
    ($($method:ident($($other:ident),*) $instruction:ident;)*) => {$(
        #[inline(always)]
        fn $method(self $(, $other: Self)*) -> Self {
            // SAFETY: see the module documentation.
            unsafe { Self($instruction(self.0 $(, $other.0)*), $instruction(self.1 $(, $other.1)*)) }
        }
    )*};
}

impl Eight {
    instructions! {
        add(other) _mm256_add_pd;
        sub(other) _mm256_sub_pd;
        mul(other) _mm256_mul_pd;
        div(other) _mm256_div_pd;
        bits_and(other) _mm256_and_pd;
        bits_or(other) _mm256_or_pd;
        bits_xor(other) _mm256_xor_pd;
        // the bits of the second operand that the first does not have
        bits_not_in(other) _mm256_andnot_pd;
    }

    #[inline(always)]
    fn neg(self) -> Self {
        self.bits_xor(<Self as Lane>::splat(-0.0))
    }
}

impl EightBits {
    instructions! {
        bitand(other) _mm256_and_pd;
        bitor(other) _mm256_or_pd;
        bits_xor(other) _mm256_xor_pd;
    }

    #[inline(always)]
    fn not(self) -> Self {
        self.bits_xor(<Self as Mask>::splat(true))
    }
}

operators!(Eight, EightBits);

impl Mask for EightBits {
    #[inline(always)]
    fn splat(value: bool) -> Self {
        // SAFETY: see the module documentation.
        let half = unsafe { _mm256_castsi256_pd(_mm256_set1_epi64x(-i64::from(value))) };
        Self(half, half)
    }
    #[inline(always)]
    fn any(self) -> bool {
        // SAFETY: see the module documentation.
        unsafe { _mm256_movemask_pd(_mm256_or_pd(self.0, self.1)) != 0 }
    }
}

impl Lane for Eight {
    type Mask = EightBits;

    const COUNT: usize = WIDTH;

    instructions! {
        sqrt() _mm256_sqrt_pd;
        // of equal numbers, and where one is NaN, the second operand: as the selects do
        min(other) _mm256_min_pd;
        max(other) _mm256_max_pd;
    }

    #[inline(always)]
    fn splat(value: f64) -> Self {
        // SAFETY: see the module documentation.
        let half = unsafe { _mm256_set1_pd(value) };
        Self(half, half)
    }
    #[inline(always)]
    fn lane(self, index: usize) -> f64 {
        self.store()[index]
    }
    #[inline(always)]
    fn map_where(self, mask: EightBits, each: impl Fn(f64) -> f64) -> Self {
        map_where(self, mask, each)
    }
    #[inline(always)]
    fn with_lane(self, index: usize, value: f64) -> Self {
        let mut block = self.store();
        block[index] = value;
        Self::load(&block)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self::splat(-0.0).bits_not_in(self)
    }
    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        self.abs().bits_or(Self::splat(-0.0).bits_and(sign))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> EightBits {
        // SAFETY: see the module documentation.
        unsafe {
            EightBits(
                _mm256_cmp_pd::<_CMP_LT_OQ>(self.0, other.0),
                _mm256_cmp_pd::<_CMP_LT_OQ>(self.1, other.1),
            )
        }
    }
    #[inline(always)]
    fn le(self, other: Self) -> EightBits {
        // SAFETY: see the module documentation.
        unsafe {
            EightBits(
                _mm256_cmp_pd::<_CMP_LE_OQ>(self.0, other.0),
                _mm256_cmp_pd::<_CMP_LE_OQ>(self.1, other.1),
            )
        }
    }
    #[inline(always)]
    fn select(mask: EightBits, yes: Self, no: Self) -> Self {
        // SAFETY: see the module documentation.
        unsafe {
            Self(
                _mm256_blendv_pd(no.0, yes.0, mask.0),
                _mm256_blendv_pd(no.1, yes.1, mask.1),
            )
        }
    }
}

impl Wide for Eight {
    #[inline(always)]
    fn load(block: &Block) -> Self {
        let (low, high) = block.split_at(4);
        // SAFETY: see the module documentation; each half is four numbers, at any address.
        unsafe {
            Self(
                _mm256_loadu_pd(low.as_ptr()),
                _mm256_loadu_pd(high.as_ptr()),
            )
        }
    }
    #[inline(always)]
    fn store(self) -> Block {
        let mut block = [0.0; 8];
        let (low, high) = block.split_at_mut(4);
        // SAFETY: as in `load`.
        unsafe {
            _mm256_storeu_pd(low.as_mut_ptr(), self.0);
            _mm256_storeu_pd(high.as_mut_ptr(), self.1);
        }
        block
    }
    #[inline(always)]
    fn bits(mask: EightBits) -> Bits {
        // SAFETY: see the module documentation.
        let (low, high) = unsafe { (_mm256_movemask_pd(mask.0), _mm256_movemask_pd(mask.1)) };
        // four bits each
        (low | high << 4).to_le_bytes()[0]
    }
    #[inline(always)]
    fn mask(bits: Bits) -> EightBits {
        // SAFETY: see the module documentation.
        let half = |bits: i64| unsafe {
            let places = _mm256_set_epi64x(8, 4, 2, 1);
            let set = _mm256_and_si256(_mm256_set1_epi64x(bits), places);
            _mm256_castsi256_pd(_mm256_cmpeq_epi64(set, places))
        };
        EightBits(half(i64::from(bits)), half(i64::from(bits >> 4)))
    }

    by_permutation!(Picks);
}

/// The permutation of both registers along a route.
#[derive(Clone, Copy)]
struct Picks {
    low: Half,
    high: Half,
    goals: EightBits,
}

impl Picks {
    #[inline(always)]
    fn of(route: &Route) -> Self {
        let [a, b, c, d, e, f, g, h] = route.sources();
        Self {
            low: Half::of([a, b, c, d]),
            high: Half::of([e, f, g, h]),
            goals: Eight::mask(route.to()),
        }
    }

    #[inline(always)]
    fn pick(self, from: Eight, to: Eight) -> Eight {
        Eight::select(
            self.goals,
            Eight(self.low.pick(from), self.high.pick(from)),
            to,
        )
    }
}

/// The sources of the numbers of one half.
#[derive(Debug, Clone, Copy)]
struct Half {
    /// Positions within their half, of both 32-bit words of a number.
    words: __m256i,
    /// Whether they come from the higher half.
    high: __m256d,
}

impl Half {
    #[inline(always)]
    fn of(sources: [u8; 4]) -> Self {
        let [a, b, c, d] = sources.map(i32::from);
        let place = |lane: i32| 2 * (lane & 3);
        let half = |lane: i32| -i64::from((lane >> 2) & 1);
        let [p, q, r, s] = [place(a), place(b), place(c), place(d)];
        // SAFETY: see the module documentation.
        unsafe {
            Self {
                words: _mm256_setr_epi32(p, p + 1, q, q + 1, r, r + 1, s, s + 1),
                high: _mm256_castsi256_pd(_mm256_set_epi64x(half(d), half(c), half(b), half(a))),
            }
        }
    }

    #[inline(always)]
    fn pick(self, from: Eight) -> __m256d {
        // SAFETY: see the module documentation.
        unsafe {
            let low = _mm256_permutevar8x32_ps(_mm256_castpd_ps(from.0), self.words);
            let high = _mm256_permutevar8x32_ps(_mm256_castpd_ps(from.1), self.words);
            _mm256_blendv_pd(_mm256_castps_pd(low), _mm256_castps_pd(high), self.high)
        }
    }
}

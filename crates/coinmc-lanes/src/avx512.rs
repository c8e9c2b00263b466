//! Eight lanes in one register of AVX-512.
//!
//! # Safety
//! Every method uses instructions that the processor must have. The type is private to the crate,
//! and its values exist only inside [`enter`], which checks the processor first.
#![allow(unsafe_code)]

use crate::operators::{by_permutation, operators};
use crate::wide::{Bits, Block, WIDTH, Wide, Work, map_where};
use crate::{Lane, Mask, Route};
use std::arch::x86_64::{
    __m512d, __m512i, __mmask8, _CMP_LE_OQ, _CMP_LT_OQ, _mm_cvtsi64_si128, _mm512_abs_pd,
    _mm512_add_pd, _mm512_and_si512, _mm512_andnot_si512, _mm512_castpd_si512, _mm512_castsi512_pd,
    _mm512_cmp_pd_mask, _mm512_cvtepu8_epi64, _mm512_div_pd, _mm512_loadu_pd, _mm512_mask_blend_pd,
    _mm512_max_pd, _mm512_min_pd, _mm512_mul_pd, _mm512_or_si512, _mm512_permutexvar_pd,
    _mm512_set1_pd, _mm512_sqrt_pd, _mm512_storeu_pd, _mm512_sub_pd, _mm512_xor_si512,
};
use std::sync::LazyLock;

#[derive(Debug, Clone, Copy)]
#[repr(transparent)]
pub(crate) struct Eight(__m512d);

#[derive(Debug, Clone, Copy)]
pub(crate) struct EightBits(__mmask8);

/// Whether the processor has all features that [`enter`] uses, as every one with AVX-512 since
/// Skylake-SP does.
#[inline]
pub(crate) fn is_available() -> bool {
    static IS_AVAILABLE: LazyLock<bool> = LazyLock::new(|| {
        is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512vl")
            && is_x86_feature_detected!("avx512dq")
            && is_x86_feature_detected!("avx512bw")
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
    // beside AVX-512F itself, features with which the compiler makes faster code
    #[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,bmi1,bmi2,lzcnt,popcnt")]
    fn inside<W: Work>(work: W) -> W::Output {
        work.run::<Eight>()
    }
    // SAFETY: the processor has all of the features.
    is_available().then(|| unsafe { inside(work) })
}

/// Methods of one instruction each.
macro_rules! instructions {
    ($($method:ident($($other:ident),*) $instruction:ident;)*) => {$(
        #[inline(always)]
        fn $method(self $(, $other: Self)*) -> Self {
            // SAFETY: see the module documentation.
            Self(unsafe { $instruction(self.0 $(, $other.0)*) })
        }
    )*};
}

impl Eight {
    instructions! {
        add(other) _mm512_add_pd;
        sub(other) _mm512_sub_pd;
        mul(other) _mm512_mul_pd;
        div(other) _mm512_div_pd;
    }

    #[inline(always)]
    fn neg(self) -> Self {
        // SAFETY: see the module documentation.
        Self(unsafe {
            let sign = _mm512_castpd_si512(_mm512_set1_pd(-0.0));
            _mm512_castsi512_pd(_mm512_xor_si512(_mm512_castpd_si512(self.0), sign))
        })
    }
}

impl EightBits {
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }
    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
    #[inline(always)]
    fn not(self) -> Self {
        Self(!self.0)
    }
}

operators!(Eight, EightBits);

impl Mask for EightBits {
    #[inline(always)]
    fn splat(value: bool) -> Self {
        Self(if value { __mmask8::MAX } else { 0 })
    }
    #[inline(always)]
    fn any(self) -> bool {
        self.0 != 0
    }
}

impl Lane for Eight {
    type Mask = EightBits;

    const COUNT: usize = WIDTH;

    instructions! {
        sqrt() _mm512_sqrt_pd;
        abs() _mm512_abs_pd;
        // of equal numbers, and where one is NaN, the second operand: as the selects do
        min(other) _mm512_min_pd;
        max(other) _mm512_max_pd;
    }

    #[inline(always)]
    fn splat(value: f64) -> Self {
        // SAFETY: see the module documentation.
        Self(unsafe { _mm512_set1_pd(value) })
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
    fn copysign(self, sign: Self) -> Self {
        // SAFETY: see the module documentation.
        Self(unsafe {
            let bit = _mm512_castpd_si512(_mm512_set1_pd(-0.0));
            let size = _mm512_andnot_si512(bit, _mm512_castpd_si512(self.0));
            let sign = _mm512_and_si512(bit, _mm512_castpd_si512(sign.0));
            _mm512_castsi512_pd(_mm512_or_si512(size, sign))
        })
    }
    #[inline(always)]
    fn lt(self, other: Self) -> EightBits {
        // SAFETY: see the module documentation.
        EightBits(unsafe { _mm512_cmp_pd_mask::<_CMP_LT_OQ>(self.0, other.0) })
    }
    #[inline(always)]
    fn le(self, other: Self) -> EightBits {
        // SAFETY: see the module documentation.
        EightBits(unsafe { _mm512_cmp_pd_mask::<_CMP_LE_OQ>(self.0, other.0) })
    }
    #[inline(always)]
    fn select(mask: EightBits, yes: Self, no: Self) -> Self {
        // SAFETY: see the module documentation.
        Self(unsafe { _mm512_mask_blend_pd(mask.0, no.0, yes.0) })
    }
}

impl Wide for Eight {
    #[inline(always)]
    fn load(block: &Block) -> Self {
        // SAFETY: see the module documentation; a block is eight numbers, at any address.
        Self(unsafe { _mm512_loadu_pd(block.as_ptr()) })
    }
    #[inline(always)]
    fn store(self) -> Block {
        let mut block = [0.0; 8];
        // SAFETY: as in `load`.
        unsafe { _mm512_storeu_pd(block.as_mut_ptr(), self.0) };
        block
    }
    #[inline(always)]
    fn bits(mask: EightBits) -> Bits {
        mask.0
    }
    #[inline(always)]
    fn mask(bits: Bits) -> EightBits {
        EightBits(bits)
    }

    by_permutation!(Picks);
}

/// The permutation of a register along a route.
#[derive(Clone, Copy)]
struct Picks {
    sources: __m512i,
    goals: EightBits,
}

impl Picks {
    #[inline(always)]
    fn of(route: &Route) -> Self {
        let sources = i64::from_le_bytes(route.sources());
        Self {
            // SAFETY: see the module documentation.
            sources: unsafe { _mm512_cvtepu8_epi64(_mm_cvtsi64_si128(sources)) },
            goals: EightBits(route.to()),
        }
    }

    #[inline(always)]
    fn pick(self, from: Eight, to: Eight) -> Eight {
        // SAFETY: see the module documentation.
        let picked = Eight(unsafe { _mm512_permutexvar_pd(self.sources, from.0) });
        Eight::select(self.goals, picked, to)
    }
}

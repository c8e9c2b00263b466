//! Eight lanes as plain arrays. The compiler turns these loops into the vector instructions that it
//! may assume (NEON on AArch64).

use crate::operators::operators;
use crate::wide::{Bits, Block, WIDTH, Wide, map_where};
use crate::{Lane, Mask, Route};
use std::array::from_fn;

#[derive(Debug, Clone, Copy)]
pub(crate) struct Eight(Block);

/// All bits of a lane set, or none of them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct EightBits([u64; WIDTH]);

/// Methods that apply a scalar function to every lane.
macro_rules! lane_by_lane {
    ($($method:ident($($other:ident),*) $each:expr;)*) => {$(
        #[inline(always)]
        fn $method(self $(, $other: Self)*) -> Self {
            Self(from_fn(|i| $each(self.0[i] $(, $other.0[i])*)))
        }
    )*};
}

impl Eight {
    lane_by_lane! {
        add(other) |a: f64, b: f64| a + b;
        sub(other) |a: f64, b: f64| a - b;
        mul(other) |a: f64, b: f64| a * b;
        div(other) |a: f64, b: f64| a / b;
        neg() |a: f64| -a;
    }
}

impl EightBits {
    lane_by_lane! {
        bitand(other) |a: u64, b: u64| a & b;
        bitor(other) |a: u64, b: u64| a | b;
        not() |a: u64| !a;
    }
}

operators!(Eight, EightBits);

/// All bits, or none.
#[inline(always)]
fn all(value: bool) -> u64 {
    u64::from(value).wrapping_neg()
}

impl Mask for EightBits {
    #[inline(always)]
    fn splat(value: bool) -> Self {
        Self([all(value); WIDTH])
    }
    #[inline(always)]
    fn any(self) -> bool {
        self.0.iter().fold(0, |any, lane| any | lane) != 0
    }
}

impl Lane for Eight {
    type Mask = EightBits;

    const COUNT: usize = WIDTH;

    lane_by_lane! {
        sqrt() f64::sqrt;
        abs() f64::abs;
        copysign(sign) f64::copysign;
    }

    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self([value; WIDTH])
    }
    #[inline(always)]
    fn lane(self, index: usize) -> f64 {
        self.0[index]
    }
    #[inline(always)]
    fn map_where(self, mask: EightBits, each: impl Fn(f64) -> f64) -> Self {
        map_where(self, mask, each)
    }
    #[inline(always)]
    fn with_lane(mut self, index: usize, value: f64) -> Self {
        self.0[index] = value;
        self
    }
    #[inline(always)]
    fn lt(self, other: Self) -> EightBits {
        EightBits(from_fn(|i| all(self.0[i] < other.0[i])))
    }
    #[inline(always)]
    fn le(self, other: Self) -> EightBits {
        EightBits(from_fn(|i| all(self.0[i] <= other.0[i])))
    }
    #[inline(always)]
    fn select(mask: EightBits, yes: Self, no: Self) -> Self {
        Self(from_fn(|i| {
            let mask = mask.0[i];
            f64::from_bits((yes.0[i].to_bits() & mask) | (no.0[i].to_bits() & !mask))
        }))
    }
}

impl Wide for Eight {
    #[inline(always)]
    fn load(block: &Block) -> Self {
        Self(*block)
    }
    #[inline(always)]
    fn store(self) -> Block {
        self.0
    }
    #[inline(always)]
    fn bits(mask: EightBits) -> Bits {
        (0..WIDTH).fold(0, |bits, i| bits | (Bits::from(mask.0[i] != 0) << i))
    }
    #[inline(always)]
    fn mask(bits: Bits) -> EightBits {
        EightBits(from_fn(|i| all(bits & (1 << i) != 0)))
    }

    #[inline(always)]
    fn follow<const N: usize>(route: &Route, from: &[Block; N], to: &mut [Block; N]) {
        for (source, goal) in route.pairs() {
            for (to, from) in to.iter_mut().zip(from) {
                to[goal] = from[source];
            }
        }
    }
    #[inline(always)]
    fn follow_bits(route: &Route, from: Bits, to: Bits) -> Bits {
        route.pairs().fold(to, |bits, (source, goal)| {
            (bits & !(1 << goal)) | (((from >> source) & 1) << goal)
        })
    }
}

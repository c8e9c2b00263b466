//! Four lanes for tests, computed one by one: a reference for the lanes of the kernels.

use coinmc_lanes::{Lane, Mask};
use std::array::from_fn;
use std::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, MulAssign, Neg, Not, Sub, SubAssign};

#[derive(Debug, Clone, Copy)]
pub(crate) struct Four(pub(crate) [f64; 4]);

#[derive(Debug, Clone, Copy)]
pub(crate) struct Bits(pub(crate) [bool; 4]);

macro_rules! arithmetic {
    ($($trait:ident $method:ident $op:tt;)*) => {$(
        impl $trait for Four {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                Self(from_fn(|i| self.0[i] $op other.0[i]))
            }
        }
    )*};
}
arithmetic! {
    Add add +;
    Sub sub -;
    Mul mul *;
    Div div /;
}

impl AddAssign for Four {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
impl SubAssign for Four {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}
impl MulAssign for Four {
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}
impl Neg for Four {
    type Output = Self;
    fn neg(self) -> Self {
        Self(self.0.map(|x| -x))
    }
}

impl BitAnd for Bits {
    type Output = Self;
    fn bitand(self, other: Self) -> Self {
        Self(from_fn(|i| self.0[i] & other.0[i]))
    }
}
impl BitOr for Bits {
    type Output = Self;
    fn bitor(self, other: Self) -> Self {
        Self(from_fn(|i| self.0[i] | other.0[i]))
    }
}
impl Not for Bits {
    type Output = Self;
    fn not(self) -> Self {
        Self(self.0.map(|x| !x))
    }
}
impl Mask for Bits {
    fn splat(value: bool) -> Self {
        Self([value; 4])
    }
    fn any(self) -> bool {
        self.0.iter().any(|x| *x)
    }
}

impl Lane for Four {
    type Mask = Bits;

    const COUNT: usize = 4;

    fn splat(value: f64) -> Self {
        Self([value; 4])
    }
    fn lane(self, index: usize) -> f64 {
        self.0[index]
    }
    fn map_where(self, mask: Bits, each: impl Fn(f64) -> f64) -> Self {
        Self(from_fn(|i| self.0[i].map_where(mask.0[i], &each)))
    }
    fn with_lane(mut self, index: usize, value: f64) -> Self {
        self.0[index] = value;
        self
    }
    fn sqrt(self) -> Self {
        Self(self.0.map(f64::sqrt))
    }
    fn abs(self) -> Self {
        Self(self.0.map(f64::abs))
    }
    fn copysign(self, sign: Self) -> Self {
        Self(from_fn(|i| self.0[i].copysign(sign.0[i])))
    }
    fn lt(self, other: Self) -> Bits {
        Bits(from_fn(|i| self.0[i] < other.0[i]))
    }
    fn le(self, other: Self) -> Bits {
        Bits(from_fn(|i| self.0[i] <= other.0[i]))
    }
    fn select(mask: Bits, yes: Self, no: Self) -> Self {
        Self(from_fn(|i| if mask.0[i] { yes.0[i] } else { no.0[i] }))
    }
}

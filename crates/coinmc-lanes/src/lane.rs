//! The arithmetic of the kernels: one number, or one per lane.
//!
//! Flight, impact and contact are written once, over [`Lane`]. A lane offers only what IEEE 754
//! fixes to the last bit (no fused operations, no library functions), and a choice made by a
//! comparison is a [`select`](Lane::select): so the number of lanes changes the speed and nothing
//! else. With `f64` as the lane, masks are `bool` and selects compile to moves or branches; a
//! [`Wide`](crate::Wide) type holds eight lanes.

use std::fmt::Debug;
use std::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, MulAssign, Neg, Not, Sub, SubAssign};

/// One `f64`, or one per lane.
pub trait Lane:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
{
    /// The result of a comparison, lane by lane.
    type Mask: Mask;

    /// The number of lanes.
    const COUNT: usize;

    /// The same number in every lane.
    fn splat(value: f64) -> Self;
    /// The number in one lane, 0 to [`COUNT`](Self::COUNT) − 1, for scalar code.
    fn lane(self, index: usize) -> f64;
    /// The same with another number in one lane, 0 to [`COUNT`](Self::COUNT) − 1.
    fn with_lane(self, index: usize, value: f64) -> Self;
    /// Applies scalar code, `each`, to the lanes of the mask and leaves the others unchanged.
    fn map_where(self, mask: Self::Mask, each: impl Fn(f64) -> f64) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Magnitude.
    fn abs(self) -> Self;
    /// The magnitude of `self` with the sign of `sign`.
    fn copysign(self, sign: Self) -> Self;
    /// self < other; false where either is NaN.
    fn lt(self, other: Self) -> Self::Mask;
    /// self <= other; false where either is NaN.
    fn le(self, other: Self) -> Self::Mask;
    /// `yes` where the mask is set, else `no`.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;

    /// The nearest integer, ties to even.
    #[inline(always)]
    fn round(self) -> Self {
        // Adding 3·2^51 leaves no digits after the binary point. Exact for |self| < 2^51, and
        // without SSE 4.1 much faster than the library's round.
        const SHIFT: f64 = 6_755_399_441_055_744.0;
        let shift = Self::splat(SHIFT);
        let near = self.abs().lt(Self::splat(2_251_799_813_685_248.0));
        Self::select(near, (self + shift) - shift, self)
    }

    /// The largest integer that is at most `self`.
    #[inline(always)]
    fn floor(self) -> Self {
        // from 2^52 on all numbers are integers, so adding 2^52 leaves no digits after the binary
        // point
        let shift = Self::splat(4_503_599_627_370_496.0);
        let size = self.abs();
        let near = ((size + shift) - shift).copysign(self);
        let near = Self::select(size.lt(shift), near, self);
        Self::select(self.lt(near), near - Self::splat(1.0), near)
    }

    /// The smaller of the two; `other` where `self` is NaN.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self::select(self.lt(other), self, other)
    }

    /// The larger of the two; `other` where `self` is NaN.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::select(other.lt(self), self, other)
    }
}

/// One truth value, or one per lane.
pub trait Mask:
    Copy + Debug + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self>
{
    /// The same value in every lane.
    fn splat(value: bool) -> Self;
    /// Whether any lane is set.
    fn any(self) -> bool;
}

impl Mask for bool {
    #[inline(always)]
    fn splat(value: bool) -> Self {
        value
    }
    #[inline(always)]
    fn any(self) -> bool {
        self
    }
}

impl Lane for f64 {
    type Mask = bool;

    const COUNT: usize = 1;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn lane(self, index: usize) -> f64 {
        debug_assert!(index < Self::COUNT, "lane {index}");
        self
    }
    #[inline(always)]
    fn with_lane(self, index: usize, value: f64) -> Self {
        debug_assert!(index < Self::COUNT, "lane {index}");
        value
    }
    #[inline(always)]
    fn map_where(self, mask: bool, each: impl Fn(f64) -> f64) -> Self {
        if mask { each(self) } else { self }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }
    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        f64::copysign(self, sign)
    }
    #[inline(always)]
    fn lt(self, other: Self) -> bool {
        self < other
    }
    #[inline(always)]
    fn le(self, other: Self) -> bool {
        self <= other
    }
    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Block, Lanes, WIDTH, Wide, Work};

    #[test]
    fn floor_rounds_down() {
        for x in [
            -7.0, -2.5, -0.3, 0.0, 0.3, 0.5, 1.0, 1.5, 6.999, 1e12, -1e18,
        ] {
            assert_eq!(Lane::floor(x), f64::floor(x), "{x}");
        }
        assert!(Lane::floor(f64::NAN).is_nan());
    }

    /// Writes another number into each lane, the last lane first.
    struct Numbered;

    impl Work for Numbered {
        type Output = Block;

        #[inline(always)]
        fn run<L: Wide>(self) -> Block {
            assert_eq!(L::COUNT, WIDTH);
            let filled = (0..L::COUNT).rev().fold(L::splat(-1.0), |lanes, i| {
                let lanes = lanes.with_lane(i, 0.5 + i as f64);
                assert_eq!(lanes.lane(i), 0.5 + i as f64);
                assert!(
                    i == 0 || lanes.lane(i - 1) == -1.0,
                    "lane {i} changed another"
                );
                lanes
            });
            let block = filled.store();
            for (i, &number) in block.iter().enumerate() {
                assert_eq!(filled.lane(i), number);
            }
            block
        }
    }

    /// Doubles numbers above 3.
    struct Doubled(Block);

    impl Work for Doubled {
        type Output = Block;

        #[inline(always)]
        fn run<L: Wide>(self) -> Block {
            let lanes = L::load(&self.0);
            let above = L::splat(3.0).lt(lanes);
            lanes.map_where(above, |number| 2.0 * number).store()
        }
    }

    #[test]
    fn map_where_changes_the_lanes_of_the_mask() {
        let numbers = [1.0, 4.0, 2.0, 3.0, 5.0, 3.5, 0.0, 8.0];
        for lanes in Lanes::wide() {
            let block = lanes.enter(Doubled(numbers));
            assert_eq!(block, [1.0, 8.0, 2.0, 3.0, 10.0, 7.0, 0.0, 16.0], "{lanes}");
        }
        assert_eq!(2.0_f64.map_where(true, |number| 2.0 * number), 4.0);
        assert_eq!(2.0_f64.map_where(false, |number| 2.0 * number), 2.0);
    }

    #[test]
    fn every_lane_is_read_and_written_separately() {
        for lanes in Lanes::wide() {
            let block = lanes.enter(Numbered);
            assert_eq!(block, [0.5, 1.5, 2.5, 3.5, 4.5, 5.5, 6.5, 7.5], "{lanes}");
        }
        assert_eq!(f64::COUNT, 1);
        assert_eq!(2.5_f64.with_lane(0, 3.5).lane(0), 3.5);
    }
}

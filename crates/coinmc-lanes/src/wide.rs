//! Lanes of a fixed number, as the batch of tosses uses them: to and from memory, and masks as bits.

use crate::{Lane, Route};

/// Tosses side by side, whatever the instruction set: one register of AVX-512, two of AVX2.
pub const WIDTH: usize = 8;

/// One number of each of them.
pub type Block = [f64; WIDTH];

/// One truth value of each, the first in the lowest bit.
pub type Bits = u8;

/// [`WIDTH`] lanes.
pub trait Wide: Lane {
    /// The lanes that memory holds.
    fn load(block: &Block) -> Self;
    /// The lanes, for memory.
    fn store(self) -> Block;
    /// Set bits of a mask.
    fn bits(mask: Self::Mask) -> Bits;
    /// The mask of set bits.
    fn mask(bits: Bits) -> Self::Mask;
    /// Puts the lanes of `from` that go along a route into those of `to`, in every block.
    fn follow<const N: usize>(route: &Route, from: &[Block; N], to: &mut [Block; N]);
    /// The same of one truth value a lane: `to`, with those of `from` that go.
    fn follow_bits(route: &Route, from: Bits, to: Bits) -> Bits;
}

/// [`Lane::map_where`] through memory.
#[inline(always)]
pub(crate) fn map_where<L: Wide>(lanes: L, mask: L::Mask, each: impl Fn(f64) -> f64) -> L {
    let mut block = lanes.store();
    for lane in lanes_of(L::bits(mask)) {
        block[lane] = each(block[lane]);
    }
    L::load(&block)
}

/// Something that is done on lanes of any kind. Its `run` and all that this calls are to be
/// inlined: only then are they compiled for the instruction set they run on.
pub trait Work {
    /// What comes of it.
    type Output;

    /// Does it.
    fn run<L: Wide>(self) -> Self::Output;
}

/// Where the lanes of `bits` are, in rising order.
pub fn lanes_of(mut bits: Bits) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        (bits != 0).then(|| {
            let lane = bits.trailing_zeros() as usize;
            bits &= bits - 1;
            lane
        })
    })
}

/// The first `count` lanes.
pub fn first(count: usize) -> Bits {
    Bits::try_from((1_u32 << count) - 1).unwrap_or(Bits::MAX)
}

//! Eight lanes, as batches of tosses use them: to and from memory, and masks as bits.

use crate::{Lane, Route};

/// The number of wide lanes with any instruction set: one register of AVX-512, two of AVX2.
pub const WIDTH: usize = 8;

/// One number per lane.
pub type Block = [f64; WIDTH];

/// One truth value per lane, the first in the lowest bit.
pub type Bits = u8;

/// [`WIDTH`] lanes.
pub trait Wide: Lane {
    /// Reads the lanes from memory.
    fn load(block: &Block) -> Self;
    /// The lanes as memory holds them.
    fn store(self) -> Block;
    /// The mask as bits.
    fn bits(mask: Self::Mask) -> Bits;
    /// The mask with these bits set.
    fn mask(bits: Bits) -> Self::Mask;
    /// Copies lanes of `from` along a route into lanes of `to`, in every block.
    fn follow<const N: usize>(route: &Route, from: &[Block; N], to: &mut [Block; N]);
    /// The same for one truth value per lane: `to`, with the copied ones of `from`.
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

/// Work to do on lanes of any kind. `run` and all that it calls must be inlined: only then is it
/// compiled for the instruction set it runs on.
pub trait Work {
    /// Its result.
    type Output;

    /// Does the work.
    fn run<L: Wide>(self) -> Self::Output;
}

/// The lanes whose bits are set, in rising order.
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

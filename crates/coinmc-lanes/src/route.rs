//! Copying lanes of one block to lanes of another.

use crate::wide::{Bits, WIDTH};

/// Which lanes of one block are copied to which lanes of another.
///
/// # Example
/// ```
/// use coinmc_lanes::{Block, Lanes, Route, Wide, Work};
///
/// struct Move<'a>(&'a [Block; 1], &'a mut [Block; 1], Route);
///
/// impl Work for Move<'_> {
///     type Output = ();
///
///     #[inline(always)]
///     fn run<L: Wide>(self) {
///         L::follow(&self.2, self.0, self.1);
///     }
/// }
///
/// let tens = [[10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0]];
/// let mut numbers = [[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]];
/// let route = Route::between(0b0110_0100, 0b1000_0001);
/// if let Some(lanes) = Lanes::wide().next() {
///     lanes.enter(Move(&tens, &mut numbers, route));
///     assert_eq!(numbers, [[30.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 60.0]]);
/// }
/// assert_eq!((route.from(), route.to()), (0b0010_0100, 0b1000_0001));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Route {
    /// The source of each target lane.
    sources: [u8; WIDTH],
    from: Bits,
    to: Bits,
}

impl Route {
    /// From the first lane of `from` to the first of `to`, and so on until either runs out.
    #[inline(always)]
    pub fn between(from: Bits, to: Bits) -> Self {
        let count = from.count_ones().min(to.count_ones()) as usize;
        let from = FIRST[usize::from(from)][count];
        let to = FIRST[usize::from(to)][count];
        let places = u64::from_le_bytes(PLACES[usize::from(from)]);
        // without branches, because the number of lanes is unpredictable
        let (mut sources, mut rank) = (0, 0);
        for lane in 0..WIDTH {
            sources |= ((places >> (8 * rank)) & 7) << (8 * lane);
            rank += (to >> lane) & 1;
        }
        Self {
            sources: sources.to_le_bytes(),
            from,
            to,
        }
    }

    /// From the first lane of `from` to all of `to`.
    #[inline(always)]
    pub fn to_all(from: Bits, to: Bits) -> Self {
        let from = FIRST[usize::from(from)][1];
        Self {
            sources: [PLACES[usize::from(from)][0]; WIDTH],
            from,
            to,
        }
    }

    /// The lanes that are copied.
    pub fn from(&self) -> Bits {
        self.from
    }

    /// The lanes they are copied to.
    pub fn to(&self) -> Bits {
        self.to
    }

    /// Source and target of each copied lane.
    #[cfg(any(not(target_arch = "x86_64"), debug_assertions))]
    #[inline(always)]
    pub(crate) fn pairs(&self) -> impl Iterator<Item = (usize, usize)> {
        let sources = self.sources;
        crate::wide::lanes_of(self.to).map(move |to| (usize::from(sources[to]), to))
    }

    /// The source of each lane of `to`; arbitrary for the others.
    pub(crate) fn sources(&self) -> [u8; WIDTH] {
        self.sources
    }
}

/// The first `count` lanes of a set, by the set and `count`.
static FIRST: [[Bits; WIDTH + 1]; 256] = {
    let mut first = [[0; WIDTH + 1]; 256];
    let mut bits = 0;
    while bits < 256 {
        let (mut taken, mut count, mut lane) = (0, 0, 0);
        while lane < WIDTH {
            if (bits >> lane) & 1 != 0 {
                taken |= 1 << lane;
                count += 1;
                first[bits][count] = taken;
            }
            lane += 1;
        }
        bits += 1;
    }
    first
};

/// The lanes of a set in rising order, by the set.
static PLACES: [[u8; WIDTH]; 256] = {
    let mut places = [[0; WIDTH]; 256];
    let mut bits = 0;
    while bits < 256 {
        let (mut lane, mut count) = (0, 0);
        while lane < 8 {
            if (bits >> lane) & 1 != 0 {
                places[bits][count] = lane;
                count += 1;
            }
            lane += 1;
        }
        bits += 1;
    }
    places
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Block, Lanes, Wide, Work, lanes_of};

    struct Follow(Route, [Block; 2], [Bits; 2]);

    impl Work for Follow {
        type Output = (Block, Bits);

        #[inline(always)]
        fn run<L: Wide>(self) -> (Block, Bits) {
            let Self(route, [from, to], [from_bits, to_bits]) = self;
            let mut numbers = [to];
            L::follow(&route, &[from], &mut numbers);
            (numbers[0], L::follow_bits(&route, from_bits, to_bits))
        }
    }

    #[test]
    fn each_lane_is_copied_to_the_lane_of_its_rank() {
        let from_numbers = [0.5, 1.5, 2.5, 3.5, 4.5, 5.5, 6.5, 7.5];
        let to_numbers = from_numbers.map(|number| -number);
        let (from_bits, to_bits) = (0b1011_0010, 0b0110_1010);
        for lanes in Lanes::wide() {
            // Miri takes a second for some hundred pairs
            let step = if cfg!(miri) { 29 } else { 1 };
            for from in (0..=Bits::MAX).step_by(step) {
                for to in (0..=Bits::MAX).step_by(step) {
                    let route = Route::between(from, to);
                    let (mut numbers, mut bits) = (to_numbers, to_bits);
                    let (mut taken, mut met) = (0, 0);
                    for (source, goal) in lanes_of(from).zip(lanes_of(to)) {
                        numbers[goal] = from_numbers[source];
                        bits = (bits & !(1 << goal)) | (((from_bits >> source) & 1) << goal);
                        taken |= 1 << source;
                        met |= 1 << goal;
                    }
                    assert_eq!((route.from(), route.to()), (taken, met), "{from:b} {to:b}");
                    let follow = Follow(route, [from_numbers, to_numbers], [from_bits, to_bits]);
                    assert_eq!(
                        lanes.enter(follow),
                        (numbers, bits),
                        "{lanes} {from:b} {to:b}"
                    );
                }
            }
        }
    }
}

//! The uniform random numbers of one toss.

use super::Philox4x64;
use coinmc_lanes::{Block, WIDTH};

/// Keeps independent uses of one seed apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Domain {
    /// Launches of a run.
    Launch,
    /// Scrambles of low-discrepancy points.
    Scramble,
    /// Values of numbers that are unknown.
    Parameters,
    /// Which launches are tossed.
    Acceptance,
}

impl Domain {
    /// The counter word. Every result depends on it, so its values never change.
    fn word(self) -> u64 {
        match self {
            Self::Launch => 0,
            Self::Scramble => 1,
            Self::Parameters => 2,
            Self::Acceptance => 3,
        }
    }
}

/// Uniform random numbers, one per dimension of the launch.
///
/// Random numbers and low-discrepancy points are interchangeable, because callers ask for a dimension,
/// not for the next number of a sequence.
pub trait UniformSource {
    /// The uniform of this dimension, in the open interval (0, 1).
    fn uniform(&mut self, dimension: u32) -> f64;
}

/// All tosses of one point of a run.
///
/// # Example
/// ```
/// use coinmc_core::{Domain, Stream, UniformSource};
/// let stream = Stream::new(1, Domain::Launch, 0);
/// let alone = stream.toss(7).uniform(3);
/// let mut again = stream.toss(7);
/// again.uniform(0);
/// assert_eq!(alone, again.uniform(3));      // no state: order does not matter
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stream {
    philox: Philox4x64,
    point: u64,
    domain: u64,
}

impl Stream {
    /// The stream of a point. Points that share `point` share their random numbers (paired
    /// sweeps).
    pub fn new(seed: u64, domain: Domain, point: u64) -> Self {
        Self {
            philox: Philox4x64::new([seed, 0]),
            point,
            domain: domain.word(),
        }
    }

    /// The uniforms of toss number `toss`.
    pub fn toss(&self, toss: u64) -> TossUniforms {
        TossUniforms {
            philox: self.philox,
            counter: [0, toss, self.point, self.domain],
            block: [0; 4],
            cached: u32::MAX,
        }
    }

    /// The uniforms of eight tosses from number `first` on.
    pub(crate) fn tosses(&self, first: u64) -> EachUniforms {
        EachUniforms {
            philox: self.philox,
            counter: [0, first, self.point, self.domain],
            blocks: [[0; WIDTH]; 4],
            cached: u32::MAX,
        }
    }
}

/// The uniforms of one toss, computed four at a time and on demand.
#[derive(Debug, Clone)]
pub struct TossUniforms {
    philox: Philox4x64,
    counter: [u64; 4],
    block: [u64; 4],
    /// Index of the current block; `u32::MAX`, which belongs to no dimension, if there is none.
    cached: u32,
}

impl TossUniforms {
    /// The 64-bit random word of this dimension, from which [`UniformSource::uniform`] is computed.
    #[inline]
    pub fn word(&mut self, dimension: u32) -> u64 {
        let index = dimension / 4;
        if index != self.cached {
            self.counter[0] = u64::from(index);
            self.block = self.philox.block(self.counter);
            self.cached = index;
        }
        self.block[(dimension % 4) as usize]
    }
}

impl UniformSource for TossUniforms {
    #[inline]
    fn uniform(&mut self, dimension: u32) -> f64 {
        unit_interval(self.word(dimension))
    }
}

/// The uniforms of eight consecutive tosses in lanes, bit-identical to those of the scalar path.
#[derive(Debug, Clone)]
pub(crate) struct EachUniforms {
    philox: Philox4x64,
    /// The stream of the first toss.
    counter: [u64; 4],
    /// The current block: for each of its words, the word of every toss.
    blocks: [[u64; WIDTH]; 4],
    cached: u32,
}

impl EachUniforms {
    #[inline(always)]
    pub(crate) fn uniforms(&mut self, dimension: u32) -> Block {
        let index = dimension / 4;
        if index != self.cached {
            self.hold(index);
        }
        self.blocks[(dimension % 4) as usize].map(unit_interval)
    }

    #[inline]
    fn hold(&mut self, index: u32) {
        let [_, first, point, domain] = self.counter;
        for i in 0..WIDTH {
            let toss = first + i as u64;
            let words = self.philox.block([u64::from(index), toss, point, domain]);
            for (block, word) in self.blocks.iter_mut().zip(words) {
                block[i] = word;
            }
        }
        self.cached = index;
    }
}

/// Maps a random word to (k + ½)/2⁵², k = its upper 52 bits: uniform, symmetric about ½, exact,
/// never 0 or 1 (which an inverse CDF would send to infinity).
#[inline]
pub fn unit_interval(word: u64) -> f64 {
    const STEP: f64 = 1.0 / (1_u64 << 52) as f64;
    ((word >> 12) as f64 + 0.5) * STEP
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_of_the_unit_interval_are_never_reached() {
        assert!(unit_interval(0) > 0.0);
        assert!(unit_interval(u64::MAX) < 1.0);
        assert_eq!(1.0 - unit_interval(u64::MAX), unit_interval(0));
    }

    /// The counter is (block of dimensions, toss, point, domain), the key the seed: what docs/methods
    /// promise, and what every count depends on.
    #[test]
    fn a_word_is_that_of_philox_at_its_place() {
        let domains = [
            (Domain::Launch, 0),
            (Domain::Scramble, 1),
            (Domain::Parameters, 2),
            (Domain::Acceptance, 3),
        ];
        for (domain, number) in domains {
            let stream = Stream::new(30, domain, 5);
            for dimension in [0_u32, 3, 4, 9, 4, 0] {
                let block = Philox4x64::new([30, 0]).block([(dimension / 4).into(), 7, 5, number]);
                let expected = block[dimension as usize % 4];
                let mut toss = stream.toss(7);
                assert_eq!(toss.word(dimension), expected, "{domain:?} {dimension}");
                assert_eq!(toss.uniform(dimension), unit_interval(expected));
                let mut eight = stream.tosses(4);
                assert_eq!(eight.uniforms(dimension)[3], unit_interval(expected));
            }
        }
    }

    /// Neighbours are 2^-52 apart, half a step from the ends.
    #[test]
    fn a_uniform_has_52_bits() {
        let step = 0.5_f64.powi(52);
        assert_eq!(unit_interval(0), step / 2.0);
        for k in [0, 1, 2, 77, (1 << 52) - 2] {
            let [low, high] = [k, k + 1].map(|k: u64| unit_interval(k << 12));
            assert_eq!(high - low, step);
            assert_eq!(unit_interval((k << 12) + 0xfff), low);
        }
    }

    #[test]
    fn points_tosses_and_dimensions_differ() {
        let mut seen = std::collections::HashSet::new();
        for seed in 0..3 {
            for point in 0..3 {
                for toss in 0..3 {
                    let mut u = Stream::new(seed, Domain::Launch, point).toss(toss);
                    for dimension in 0..9 {
                        assert!(seen.insert(u.uniform(dimension).to_bits()));
                    }
                }
            }
        }
    }
}

//! Launches drawn eight at a time.

use super::draw::{Draw, Uniforms};
use super::{Launch, LaunchDistribution};
use crate::{Coin, Stream, TossUniforms, UniformSource};
use coinmc_lanes::{Block, Lanes, WIDTH, Wide, Work};
use std::ops::Range;

/// Launches of some tosses, in order: see [`LaunchDistribution::launches`].
#[derive(Debug, Clone)]
pub struct Launches {
    distribution: LaunchDistribution,
    coin: Coin,
    stream: Stream,
    tosses: Range<u64>,
    lanes: Lanes,
    /// Those of eight tosses from a multiple of eight on, once any of them has been asked for.
    drawn: Draw<Block>,
    drawn_from: Option<u64>,
}

impl Launches {
    pub(super) fn new(
        distribution: &LaunchDistribution,
        coin: &Coin,
        stream: &Stream,
        tosses: Range<u64>,
        lanes: Lanes,
    ) -> Self {
        Self {
            distribution: *distribution,
            coin: *coin,
            stream: *stream,
            tosses,
            lanes,
            drawn: Draw::default(),
            drawn_from: None,
        }
    }

    /// Draws eight.
    #[inline(never)]
    fn draw(&mut self, from: u64) {
        let mut uniforms = [0, 1, 2, 3, 4, 5, 6, 7].map(|i| self.stream.toss(from + i));
        self.drawn = self.lanes.enter(Drawing {
            distribution: &self.distribution,
            coin: &self.coin,
            uniforms: &mut uniforms,
        });
        self.drawn_from = Some(from);
    }
}

impl Iterator for Launches {
    type Item = Launch;

    #[inline]
    fn next(&mut self) -> Option<Launch> {
        let toss = self.tosses.next()?;
        if self.lanes == Lanes::Scalar {
            let uniforms = &mut self.stream.toss(toss);
            return Some(self.distribution.launch(&self.coin, uniforms));
        }
        let lane = (toss % 8) as usize;
        if self.drawn_from != Some(toss - lane as u64) {
            self.draw(toss - lane as u64);
        }
        Some(self.drawn.launch(|block| block[lane]))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        self.tosses.size_hint()
    }
}

struct Drawing<'a> {
    distribution: &'a LaunchDistribution,
    coin: &'a Coin,
    uniforms: &'a mut [TossUniforms; WIDTH],
}

impl Work for Drawing<'_> {
    type Output = Draw<Block>;

    #[inline(always)]
    fn run<L: Wide>(self) -> Draw<Block> {
        let mut each = Each(self.uniforms);
        let drawn: Draw<L> = self.distribution.draw(self.coin, &mut each);
        drawn.store()
    }
}

/// The uniforms of eight tosses.
struct Each<'a>(&'a mut [TossUniforms; WIDTH]);

impl<L: Wide> Uniforms<L> for Each<'_> {
    #[inline(always)]
    fn uniform(&mut self, dimension: u32) -> L {
        let mut block = [0.0; WIDTH];
        for (number, uniforms) in block.iter_mut().zip(self.0.iter_mut()) {
            *number = UniformSource::uniform(uniforms, dimension);
        }
        L::load(&block)
    }
}

//! Launches drawn in lanes, eight at a time.

use super::draw::{Draw, Uniforms};
use super::{Launch, LaunchDistribution};
use crate::random::EachUniforms;
use crate::{Coin, Stream};
use coinmc_lanes::{Block, Lanes, WIDTH, Wide, Work};
use std::ops::Range;

/// Launches of a range of tosses, in order: see [`LaunchDistribution::launches`].
#[derive(Debug, Clone)]
pub struct Launches {
    distribution: LaunchDistribution,
    coin: Coin,
    stream: Stream,
    tosses: Range<u64>,
    lanes: Lanes,
    /// The launches of the eight tosses from `drawn_from`, a multiple of eight.
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
            lanes: lanes.available().unwrap_or(Lanes::Scalar),
            drawn: Draw::default(),
            drawn_from: None,
        }
    }

    /// Draws the launches of eight tosses.
    #[inline(never)]
    fn draw(&mut self, from: u64) {
        self.drawn = self.lanes.enter(Drawing {
            distribution: &self.distribution,
            coin: &self.coin,
            uniforms: self.stream.tosses(from),
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
        // below WIDTH
        #[allow(clippy::cast_possible_truncation)]
        let lane = (toss % WIDTH as u64) as usize;
        let from = toss - lane as u64;
        if self.drawn_from != Some(from) {
            self.draw(from);
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
    uniforms: EachUniforms,
}

impl Work for Drawing<'_> {
    type Output = Draw<Block>;

    #[inline(always)]
    fn run<L: Wide>(mut self) -> Draw<Block> {
        let drawn: Draw<L> = self.distribution.draw(self.coin, &mut self.uniforms);
        drawn.store()
    }
}

impl<L: Wide> Uniforms<L> for EachUniforms {
    #[inline(always)]
    fn uniform(&mut self, dimension: u32) -> L {
        L::load(&self.uniforms(dimension))
    }
}

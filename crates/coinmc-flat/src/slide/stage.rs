//! The stage of sliding: one attempt at a step of up to eight phases, one per lane.

use super::equations::{RatedState, Sliding};
use super::events::SlideEnd;
use super::phase::{SlidePhase, StepAttempt};
use crate::motion::Motion;
use crate::observer_adapter::ObserverAdapter;
use coinmc_lanes::{Bits, Block, Lanes, WIDTH, Wide, Work};

/// The attempts of eight lanes: what to compute, and the results.
#[derive(Default)]
pub(crate) struct SlideStage {
    friction: Block,
    h: Block,
    start: StateBlocks,
    end: StateBlocks,
    error: Block,
    /// Lanes in which the equations hold at the start, …
    begins: Bits,
    /// … in all stages of the step, …
    possible: Bits,
    /// … at its end.
    sound: Bits,
}

/// States with their rates, lane by lane. Before the attempt only the states at the start are
/// known.
#[derive(Default)]
struct StateBlocks {
    state: [Block; 4],
    rates: [Block; 4],
    sin: Block,
    cos: Block,
}

/// A sliding phase, with the motion of its coin.
type LaneSlide<'a> = (&'a mut SlidePhase, &'a mut Motion);

impl SlideStage {
    /// One attempt at a step of each phase, or one trial of its search for an event; the ends of
    /// the phases that end.
    pub(crate) fn advance(
        lanes: Lanes,
        phases: &mut [Option<LaneSlide<'_>>; WIDTH],
        adapter: &mut ObserverAdapter<'_, ()>,
    ) -> [Option<SlideEnd>; WIDTH] {
        let mut stage = Self::default();
        let mut k = 1.0;
        for lane in 0..WIDTH {
            // an empty lane repeats the work of the first
            if let Some((phase, _)) = phases[lane].as_ref().or(phases[0].as_ref()) {
                stage.load(lane, phase);
                k = phase.sliding.k;
            }
        }
        lanes.enter(Attempt {
            stage: &mut stage,
            k,
        });
        let mut ends = [None; WIDTH];
        for (lane, slide) in phases.iter_mut().enumerate() {
            if let Some((phase, motion)) = slide {
                ends[lane] = stage.finish(lane, phase, motion, adapter);
            }
        }
        ends
    }

    fn load(&mut self, lane: usize, phase: &SlidePhase) {
        self.friction[lane] = phase.sliding.friction;
        self.h[lane] = phase.length();
        for (block, number) in self.start.state.iter_mut().zip(phase.y) {
            block[lane] = number;
        }
    }

    fn finish(
        &self,
        lane: usize,
        phase: &mut SlidePhase,
        motion: &mut Motion,
        adapter: &mut ObserverAdapter<'_, ()>,
    ) -> Option<SlideEnd> {
        let has = |bits: Bits| bits & (1 << lane) != 0;
        let end = self.end.lane(lane);
        if phase.search.is_some() {
            let led_to = has(self.possible).then_some((end.state, end.angle));
            return phase.finish_trial(led_to, motion, adapter);
        }
        let attempt = StepAttempt {
            start: self.start.lane(lane),
            begins: has(self.begins),
            end,
            error: self.error[lane],
            possible: has(self.possible & self.sound),
        };
        phase.finish_step(attempt, motion, adapter)
    }
}

impl StateBlocks {
    fn lane(&self, lane: usize) -> RatedState {
        let gather = |blocks: &[Block; 4]| blocks.map(|block| block[lane]);
        RatedState {
            state: gather(&self.state),
            rates: gather(&self.rates),
            angle: (self.sin[lane], self.cos[lane]),
        }
    }

    #[inline(always)]
    fn store<L: Wide>(&mut self, at: &RatedState<L>) {
        for i in 0..4 {
            self.state[i] = at.state[i].store();
            self.rates[i] = at.rates[i].store();
        }
        (self.sin, self.cos) = (at.angle.0.store(), at.angle.1.store());
    }
}

/// The attempt of all lanes.
struct Attempt<'a> {
    stage: &'a mut SlideStage,
    k: f64,
}

impl Work for Attempt<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Wide>(self) {
        let stage = self.stage;
        let sliding = Sliding {
            k: self.k,
            friction: L::load(&stage.friction),
        };
        let mut state = [L::splat(0.0); 4];
        for (component, block) in state.iter_mut().zip(&stage.start.state) {
            *component = L::load(block);
        }
        let (start, begins) = sliding.at(&state);
        let step = sliding.whole_step(&start, L::load(&stage.h));
        stage.begins = L::bits(begins);
        stage.start.store(&start);
        stage.end.store(&step.end);
        stage.error = step.error.store();
        stage.possible = L::bits(step.possible);
        stage.sound = L::bits(step.sound);
    }
}

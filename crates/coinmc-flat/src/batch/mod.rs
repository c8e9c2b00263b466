//! The batch driver: many tosses in flight at once, eight per instruction.
//!
//! ```text
//! launches ─▶ searching ─▶ touching ─▶ impact ─▶ searching
//!               │    ▲                   │
//!               ▼    │                   ▼ last of a sequence, nearly flat: scalar path
//!            high above: skipped       sliding, eight at a time ─▶ impact, searching
//! ```
//!
//! A toss keeps its lane of a flight stage from launch to end. Each step of the search is made for
//! all searching lanes of a stage. A lane that has found its contact, or is high above the surface,
//! waits until enough others of its stage have come as far; they then share one impact, or one
//! jump. A lane whose toss ends is given to the next launch. Sliding is integrated for eight tosses
//! of any flight stages at a time. The rest of contact (an impact that ends a sequence of bounces,
//! a coin that is nearly flat or pivots) takes the scalar path.
//!
//! No lane depends on another and every operation is IEEE 754's, so a toss is bit-identical to the
//! scalar path, whatever tosses share its batch and with any instruction set.

mod flight_stage;
mod impact_stage;
mod pool;
mod segment_block;

use crate::decision::{EarlyDecision, decided};
use crate::impact_law::ImpactLaw;
use crate::parameters::Parameters;
use crate::slide::SlideStage;
use crate::toss::Toss;
use crate::transition::Transition;
use coinmc_core::{Landing, Launch, Outcome, TossBatch};
use coinmc_lanes::{Bits, Lanes, WIDTH, lanes_of};
use flight_stage::FlightStage;
use pool::{LaneId, Pool, SlidingToss};

/// Flight stages: while one waits for its last result, the processor works on the others. Speed is
/// the same from 4 to 16.
const STAGES: usize = 8;
/// So many lanes of a stage share an impact, or a jump, unless no lane of it is searching: an
/// impact costs more than a step of the search, which continues without the lanes that wait, and a
/// jump costs less. One more or less changes little.
const IMPACT_LANES: u32 = 5;
const SKIP_LANES: u32 = 3;

/// Tosses in flight.
pub(crate) struct Batch<'a, L> {
    parameters: &'a Parameters<L>,
    lanes: Lanes,
    stages: Vec<FlightStage>,
    pool: Pool,
}

impl<'a, L: ImpactLaw> Batch<'a, L> {
    /// An empty batch. The law must be [`BATCHED`](ImpactLaw::BATCHED).
    pub(crate) fn new(parameters: &'a Parameters<L>, lanes: Lanes) -> Self {
        Self {
            parameters,
            lanes,
            stages: vec![FlightStage::default(); STAGES],
            pool: Pool::new(STAGES),
        }
    }
}

impl<L: ImpactLaw> TossBatch for Batch<'_, L> {
    type End = Outcome;

    fn has_room(&self) -> bool {
        self.pool.has_room()
    }

    fn launch(&mut self, launch: &Launch) {
        let number = self.pool.next_number();
        let Toss { motion, counters } = self.parameters.launched(launch);
        if let Some(ended) = self.parameters.ends_at_launch(&motion, launch) {
            self.pool.ended.push((number, counters.outcome(ended)));
        } else if let Some(id) = self.pool.occupy(number) {
            let shape = &self.parameters.shape;
            self.stages[id.stage].insert(id.lane, &motion, shape, false);
        }
    }

    fn advance(&mut self) -> bool {
        let flying = self.stages.iter().any(FlightStage::has_work);
        let sliding = self.pool.sliding.len();
        if sliding >= WIDTH || !flying && sliding > 0 {
            self.advance_slides();
        } else if flying {
            FlightStage::search(&mut self.stages, self.lanes, &self.parameters.shape);
            for stage in 0..STAGES {
                self.after_search(stage);
            }
        } else {
            return false;
        }
        true
    }

    fn ended(&mut self) -> &mut Vec<(u64, Outcome)> {
        &mut self.pool.ended
    }
}

impl<L: ImpactLaw> Batch<'_, L> {
    /// Handles the lanes that a step of the search has brought out of it.
    fn after_search(&mut self, stage: usize) {
        let flights = &mut self.stages[stage];
        let lost = std::mem::take(&mut flights.lost);
        let idle = flights.searching == 0;
        let due =
            |waiting: Bits, enough: u32| waiting != 0 && (idle || waiting.count_ones() >= enough);
        if due(flights.high, SKIP_LANES) {
            flights.skip(self.lanes, &self.parameters.shape);
        }
        if due(flights.touching, IMPACT_LANES) {
            match self.parameters.landing {
                Landing::Adhesive => self.land(stage),
                Landing::Bouncing => self.bounce(stage),
            }
        }
        for lane in lanes_of(lost) {
            let motion = self.stages[stage].motion(lane);
            let ended = self.parameters.out_of_steps(&motion);
            self.pool.end(LaneId { stage, lane }, ended);
        }
    }

    /// Ends the tosses of a stage that touch an adhesive surface.
    fn land(&mut self, stage: usize) {
        let flights = &mut self.stages[stage];
        let touching = flights.touching;
        flights.land(self.lanes);
        for lane in lanes_of(touching) {
            if let Some(ended) = self.parameters.adhesive_end(&flights.motion(lane)) {
                self.pool.end(LaneId { stage, lane }, ended);
            }
        }
    }

    /// The impacts of the lanes of a stage that touch.
    fn bounce(&mut self, stage: usize) {
        let flights = &mut self.stages[stage];
        let touching = flights.touching;
        let after = flights.impact(self.lanes, self.parameters);
        for lane in lanes_of(touching & !after.scalar) {
            let id = LaneId { stage, lane };
            let slot = self.pool.slot_mut(id);
            if let Err(ended) = self.parameters.count_impact(&mut slot.counters) {
                self.stages[stage].remove(lane);
                self.pool.end(id, ended);
            } else if after.decided & (1 << lane) != 0 {
                let ended = decided(&self.stages[stage].motion(lane));
                self.pool.end(id, ended);
            }
        }
        for lane in lanes_of(after.scalar) {
            self.bounce_scalar(LaneId { stage, lane });
        }
    }

    /// Impacts and sustained contact of one toss on the scalar path, until it slides, flies or
    /// ends.
    fn bounce_scalar(&mut self, id: LaneId) {
        let mut toss = Toss {
            motion: self.stages[id.stage].motion(id.lane),
            counters: self.pool.slot_mut(id).counters,
        };
        let mut early = EarlyDecision::disabled();
        let mut unobserved = ();
        let mut adapter = self.parameters.adapter(&mut unobserved);
        let transition = self
            .parameters
            .after_touch(&mut toss, &mut early, &mut adapter);
        self.queue(id, &toss, transition);
    }

    /// Queues a toss for what it does next, or ends it.
    fn queue(&mut self, id: LaneId, toss: &Toss, transition: Transition) {
        let Toss { motion, counters } = toss;
        self.pool.slot_mut(id).counters = *counters;
        match transition {
            Transition::Fly => {
                let shape = &self.parameters.shape;
                self.stages[id.stage].insert(id.lane, motion, shape, true);
            }
            Transition::End(ended) => self.pool.end(id, ended),
            Transition::Slide(state) => self.pool.sliding.push(SlidingToss {
                id,
                motion: *motion,
                contact: self.parameters.contact.slide(motion, counters, state),
            }),
        }
    }

    /// One attempt at a step of the last tosses that slide.
    fn advance_slides(&mut self) {
        let mut unobserved = ();
        let mut adapter = self.parameters.adapter(&mut unobserved);
        let first = self.pool.sliding.len().saturating_sub(WIDTH);
        let mut sliding = self.pool.sliding[first..].iter_mut();
        let mut phases = std::array::from_fn(|_| {
            let sliding = sliding.next()?;
            Some((&mut sliding.contact.phase, &mut sliding.motion))
        });
        let ends = SlideStage::advance(self.lanes, &mut phases, &mut adapter);
        // from the last to the first, so that the toss that takes a free place has had its turn
        for index in (first..self.pool.sliding.len()).rev() {
            let Some(end) = ends[index - first] else {
                continue;
            };
            let sliding = self.pool.sliding.swap_remove(index);
            let mut toss = Toss {
                motion: sliding.motion,
                counters: self.pool.slot_mut(sliding.id).counters,
            };
            let mut early = EarlyDecision::disabled();
            let transition = self.parameters.after_sliding(
                &mut toss,
                &sliding.contact,
                end,
                &mut early,
                &mut adapter,
            );
            self.queue(sliding.id, &toss, transition);
        }
    }
}

//! Many tosses in flight, eight at a time: bit-identical to the [scalar path](crate::scalar).
//!
//! ```text
//! launches ─▶ departing ─▶ flights ─▶ impact stage ─▶ flights
//!                                          │
//!                                          ├─▶ retrying (was not the last bounce) ─▶ impact stage
//!                                          └─▶ sticking, slipping ─▶ departing, impact, ended
//! ```
//!
//! A pool holds all tosses in flight, each at one stage. A stage works on eight tosses at once, as
//! soon as eight are waiting for it: so the lanes are full although tosses take different paths. In
//! flight and in contact a toss keeps its lane from step to step; a lane that becomes free is given
//! to the next toss. Rare cases (a coin that lies, stands, jams, or changes its mode of contact)
//! are handled one by one by the code of the scalar path. With [`Lanes::Scalar`] there is no batch.
//!
//! No lane depends on another, and all operations are those of IEEE 754. So the outcome of a toss
//! is bit-identical whatever other tosses are in flight and whatever the instruction set.

mod arrivals;
mod columns;
mod contact_stage;
mod departures;
mod flight_stage;
mod flights;
mod impact_stage;
mod pool;
mod slot;

#[cfg(test)]
mod tests;

use crate::contact::Mode;
use crate::finished_toss::FinishedToss;
use crate::flight::Departure;
use crate::impact::ImpactLaw;
use crate::model::Model;
use crate::transition::Transition;
use coinmc_core::{Ended, Launch, TossBatch};
use coinmc_lanes::{Bits, Lanes, WIDTH, first, lanes_of};
use pool::{Pool, SLOTS};

pub(crate) struct Batch<'a, I> {
    model: &'a Model<I>,
    lanes: Lanes,
    pool: Pool,
    launched: u64,
    /// Tosses that have ended and are not reported yet, with their numbers.
    ended: Vec<(u64, FinishedToss)>,
}

impl<'a, I: ImpactLaw> Batch<'a, I> {
    pub(crate) fn new(model: &'a Model<I>, lanes: Lanes) -> Self {
        Self {
            model,
            lanes,
            pool: Pool::new(),
            launched: 0,
            ended: Vec::with_capacity(2 * SLOTS),
        }
    }
}

impl<I: ImpactLaw> TossBatch for Batch<'_, I> {
    type End = FinishedToss;

    fn has_room(&self) -> bool {
        !self.pool.free.is_empty() && self.ended.len() < SLOTS
    }

    /// Launches a toss into a free slot.
    fn launch(&mut self, launch: &Launch) {
        let Some(slot) = self.pool.free.pop() else {
            // not reached: callers check `has_room` first
            return;
        };
        let toss = self.model.launch(launch);
        self.pool.slots[slot].reset(self.launched, toss);
        self.launched += 1;
        match self.model.end_at_launch(&toss, launch) {
            Some(ended) => self.end(slot, ended),
            None => self.pool.departing.push(slot),
        }
    }

    /// Runs one stage: one for which eight tosses wait, otherwise one for which any do. Returns
    /// `false` if no toss is in flight.
    fn advance(&mut self) -> bool {
        let pool = &self.pool;
        if pool.flights.finished() >= WIDTH {
            self.land();
        } else if pool.departing.len() >= WIDTH && pool.flights.vacant() >= WIDTH {
            self.depart();
        } else if pool.retrying.len() >= WIDTH && pool.flights.vacant() >= WIDTH {
            self.retry_impacts();
        } else if pool.slip_stage.load(&pool.slipping) >= WIDTH {
            self.try_contact_steps(Mode::Slip);
        } else if pool.stick_stage.load(&pool.sticking) >= WIDTH {
            self.try_contact_steps(Mode::Stick);
        } else if pool.flights.any_on_search() {
            self.step_flights();
        } else if pool.flights.finished() > 0 {
            self.land();
        } else if !pool.retrying.is_empty() {
            self.retry_impacts();
        } else if !pool.departing.is_empty() {
            self.depart();
        } else if pool.slip_stage.load(&pool.slipping) > 0 {
            self.try_contact_steps(Mode::Slip);
        } else if pool.stick_stage.load(&pool.sticking) > 0 {
            self.try_contact_steps(Mode::Stick);
        } else {
            return false;
        }
        true
    }

    fn ended(&mut self) -> &mut Vec<(u64, FinishedToss)> {
        &mut self.ended
    }
}

impl<I: ImpactLaw> Batch<'_, I> {
    fn end(&mut self, slot: usize, ended: Ended) {
        let state = &self.pool.slots[slot];
        let finished = FinishedToss::new(self.model, ended, &state.toss, &state.usage);
        self.ended.push((state.number, finished));
        self.pool.free.push(slot);
    }

    /// Begins flights.
    fn depart(&mut self) {
        let (dynamics, pool) = (&self.model.dynamics, &mut self.pool);
        let count = pool.departing.len().min(WIDTH);
        let from = pool.departing.len() - count;
        let departures = &mut pool.departures;
        (departures.launched, departures.lifts_off) = (0, 0);
        for lane in 0..WIDTH {
            // unused lanes repeat the first one; their results are ignored
            let number = pool.departing[from + if lane < count { lane } else { 0 }];
            let slot = &pool.slots[number];
            departures.put(lane, number, &slot.toss.motion, &slot.toss.spin);
            departures.set_kind(lane, slot.departure);
        }
        pool.departing.truncate(from);
        let (body, drag) = (&dynamics.body, dynamics.drag);
        pool.flights
            .begin(self.lanes, body, drag, &pool.departures, first(count));
    }

    /// One step of every flight on the search for its first contact.
    fn step_flights(&mut self) {
        let dynamics = &self.model.dynamics;
        let flights = &mut self.pool.flights;
        flights.step(self.lanes, &dynamics.body, dynamics.drag);
    }

    /// Lands flights, and computes the impacts of those that land like most.
    fn land(&mut self) {
        let (model, pool) = (self.model, &mut self.pool);
        let stage = &mut pool.impact_stage;
        let count = stage.land(self.lanes, &model.dynamics, &mut pool.flights);
        let mut by_scalar = stage.unusual();
        for lane in 0..count {
            let slot = &mut pool.slots[stage.slot(lane)];
            stage.end_flight(lane, slot);
            let late = model.limits.is_late(slot.usage.time);
            let last = model.limits.no_impact_left(slot.toss.impacts);
            by_scalar |= Bits::from(late | last) << lane;
        }
        if !I::HAS_LANES || model.adhesive {
            by_scalar = Bits::MAX;
        } else if model.ground.is_some() {
            by_scalar |= stage.steep();
        }
        for lane in lanes_of(by_scalar & first(count)) {
            let next = self.after_landing(lane);
            self.apply(self.pool.impact_stage.slot(lane), next);
        }
        let in_lanes = first(count) & !by_scalar;
        if in_lanes != 0 {
            self.bounce(in_lanes, true);
        }
    }

    /// What follows the landing of a coin that is not handled in lanes.
    fn after_landing(&mut self, lane: usize) -> Transition {
        let (model, stage) = (self.model, &self.pool.impact_stage);
        let slot = &mut self.pool.slots[stage.slot(lane)];
        if stage.gave_up(lane) {
            stage.copy_start(lane, &mut slot.toss, model.dynamics.axial_factor);
            return Transition::End(model.end_given_up(&slot.toss));
        }
        stage.copy_motion(lane, &mut slot.toss);
        match model.end_at_landing(&slot.toss, slot.usage.time) {
            Some(ended) => Transition::End(ended),
            None => Transition::Impact,
        }
    }

    /// Computes impacts again that were not the last bounce.
    fn retry_impacts(&mut self) {
        let pool = &mut self.pool;
        let count = pool.retrying.len().min(WIDTH);
        let from = pool.retrying.len() - count;
        for lane in 0..WIDTH {
            let slot = pool.retrying[from + if lane < count { lane } else { 0 }];
            pool.impact_stage.put(lane, slot, &pool.slots[slot].toss);
        }
        pool.retrying.truncate(from);
        self.bounce(first(count), false);
    }

    /// Computes the impacts of the lanes of `open`, and sends each toss to its next stage.
    fn bounce(&mut self, open: Bits, may_be_last: bool) {
        let (model, pool) = (self.model, &mut self.pool);
        pool.impact_stage.bounce(self.lanes, model, may_be_last);
        let retry = open & pool.impact_stage.retry();
        for lane in 0..WIDTH {
            // unused lanes may repeat a slot, but they are not open
            let slot = &mut pool.slots[pool.impact_stage.slot(lane)];
            slot.toss.impacts += u32::from(((open & !retry) >> lane) & 1);
        }
        for lane in lanes_of(retry) {
            let slot = pool.impact_stage.slot(lane);
            pool.impact_stage
                .copy_motion(lane, &mut pool.slots[slot].toss);
            pool.retrying.push(slot);
        }
        let mut flies = open & pool.impact_stage.flies();
        for lane in lanes_of(open & !retry & !flies) {
            let pool = &mut self.pool;
            let slot = pool.impact_stage.slot(lane);
            let state = &mut pool.slots[slot];
            match pool.impact_stage.after_impact(model, lane, state) {
                Transition::Flight(Departure::Rebound) => flies |= 1 << lane,
                next => self.apply(slot, next),
            }
        }
        if flies == 0 {
            return;
        }
        let (pool, dynamics) = (&mut self.pool, &model.dynamics);
        let departures = &pool.impact_stage.after;
        pool.flights
            .begin(self.lanes, &dynamics.body, dynamics.drag, departures, flies);
    }

    /// Tries one step of sustained contact in each lane of a mode.
    fn try_contact_steps(&mut self, mode: Mode) {
        let model = self.model;
        let (stage, queue, slots) = self.pool.contact_stage(mode);
        for lane in lanes_of(stage.free()) {
            let Some(slot) = queue.pop() else {
                break;
            };
            stage.put(lane, slot, &slots[slot]);
        }
        stage.try_steps(self.lanes, model, mode);
        let attention = stage.attention;
        for lane in lanes_of(attention) {
            let (stage, _, slots) = self.pool.contact_stage(mode);
            let slot = stage.slot(lane);
            match stage.take_out(model, lane, &mut slots[slot]) {
                None => self.pool.queue_contact(slot),
                Some(next) => self.apply(slot, next),
            }
        }
    }

    /// Brings a toss to its next stage, by the scalar path where that takes an impact or a change
    /// of the mode of contact.
    fn apply(&mut self, slot: usize, mut next: Transition) {
        loop {
            let state = &mut self.pool.slots[slot];
            let mut solver = self.model.contact_solver(state.usage);
            next = match next {
                Transition::Flight(departure) => {
                    state.departure = departure;
                    self.pool.departing.push(slot);
                    return;
                }
                Transition::End(ended) => {
                    self.end(slot, ended);
                    return;
                }
                Transition::Impact => self.model.impact(&mut state.toss, &mut solver, &mut ()),
                Transition::NearGround => {
                    self.model
                        .near_ground(&mut state.toss, &mut solver, &mut ())
                }
                Transition::Contact => {
                    self.model.note_contact(&mut state.toss);
                    let (motion, spin) = (&mut state.toss.motion, &mut state.toss.spin);
                    state.phase = solver.enter(motion, spin);
                    match solver.exit_before_step(&mut state.phase, motion, spin) {
                        None => {
                            state.usage = solver.usage;
                            self.pool.queue_contact(slot);
                            return;
                        }
                        Some(exit) => self.model.after_contact(&mut state.toss, exit),
                    }
                }
            };
            state.usage = solver.usage;
        }
    }
}

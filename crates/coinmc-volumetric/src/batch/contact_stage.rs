//! Eight coins in sustained contact in one mode: each tries step after step, until one of them
//! needs the scalar path.

use super::columns::{has, load, store};
use super::slot::Slot;
use crate::contact::{
    ContactRules, ContactSolver, Mode, PhaseTransition, Rates, StepTrial, TiltSearch, Trial, place,
};
use crate::model::Model;
use crate::transition::Transition;
use coinmc_lanes::{Bits, Block, Lanes, WIDTH, Wide, Work};

const NONE: Block = [0.0; WIDTH];

/// The blocks come first, each in a cache line of its own.
#[repr(C, align(64))]
pub(super) struct ContactStage {
    state: [Block; 6],
    rates: [Block; 6],
    press: Block,
    jam_margin: Block,
    ceiling: Block,
    /// Length of the next step; in the lanes of `retry`, of the next try at this step.
    length: Block,
    steps: Block,
    time: Block,
    /// Of the last try: the step length wanted next, and what the try found.
    wanted: Block,
    now: Rates<Block>,
    trial: Trial<Block, 6>,
    slot: [usize; WIDTH],
    occupied: Bits,
    /// Lanes that need the scalar path before they can go on.
    pub(super) attention: Bits,
    retry: Bits,
    /// Lanes in a [`TiltSearch`], which sets the length of each try.
    searching: Bits,
    /// Of the last try: whether the limits allowed it, and whether an event lies within the step.
    allowed: Bits,
    eventful: Bits,
}

/// A number of steps that is held as a float.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn count(steps: f64) -> u32 {
    // from 0 to the largest u32, where the cast saturates
    steps as u32
}

impl ContactStage {
    pub(super) fn new() -> Self {
        Self {
            slot: [0; WIDTH],
            occupied: 0,
            attention: 0,
            state: [NONE; 6],
            rates: [NONE; 6],
            press: NONE,
            jam_margin: NONE,
            ceiling: NONE,
            length: NONE,
            retry: 0,
            searching: 0,
            steps: NONE,
            time: NONE,
            allowed: 0,
            eventful: 0,
            wanted: NONE,
            now: Rates {
                state: [NONE; 6],
                normal: NONE,
                friction: [NONE; 2],
                press: NONE,
                jam_margin: NONE,
            },
            trial: Trial {
                state: [NONE; 6],
                error: NONE,
                h: NONE,
                stages: [[NONE; 6]; 6],
            },
        }
    }

    /// How many coins are in the stage or in the queue before it.
    pub(super) fn load(&self, queue: &[usize]) -> usize {
        self.occupied.count_ones() as usize + queue.len()
    }

    pub(super) fn free(&self) -> Bits {
        !self.occupied
    }

    /// The slot that a lane works for.
    pub(super) fn slot(&self, lane: usize) -> usize {
        self.slot[lane]
    }

    /// Puts a coin in contact into a lane.
    #[inline]
    pub(super) fn put(&mut self, lane: usize, number: usize, slot: &Slot) {
        let phase = &slot.phase;
        self.slot[lane] = number;
        self.occupied |= 1 << lane;
        for (block, number) in self.state.iter_mut().zip(phase.state) {
            block[lane] = number;
        }
        for (block, number) in self.rates.iter_mut().zip(phase.now.state) {
            block[lane] = number;
        }
        self.press[lane] = phase.now.press;
        self.jam_margin[lane] = phase.now.jam_margin;
        self.ceiling[lane] = phase.ceiling;
        self.length[lane] = slot
            .tilt_search
            .map_or(phase.length, |search| search.length);
        let searching = Bits::from(slot.tilt_search.is_some()) << lane;
        self.retry = (self.retry & !(1 << lane)) | searching;
        self.searching = (self.searching & !(1 << lane)) | searching;
        self.steps[lane] = f64::from(slot.usage.steps);
        self.time[lane] = slot.usage.time;
    }

    /// Tries one step in each lane.
    pub(super) fn try_steps<I>(&mut self, lanes: Lanes, model: &Model<I>, mode: Mode) {
        try_steps(self, lanes, model.contact_rules(), mode);
    }

    /// Takes a coin out of its lane and handles what happened to it. Returns `None` if its contact
    /// goes on.
    pub(super) fn take_out<I>(
        &mut self,
        model: &Model<I>,
        lane: usize,
        slot: &mut Slot,
    ) -> Option<Transition> {
        self.occupied &= !(1 << lane);
        self.copy_state(lane, slot);
        let mut solver = model.contact_solver(slot.usage);
        let next = self.after_try(&mut solver, lane, slot)?;
        let (motion, spin) = (&mut slot.toss.motion, &mut slot.toss.spin);
        let mut exit = solver.apply(next, &mut slot.phase, motion, spin);
        if exit.is_none() {
            exit = solver.exit_before_step(&mut slot.phase, motion, spin);
        }
        slot.usage = solver.usage;
        exit.map(|exit| model.after_contact(&mut slot.toss, exit))
    }

    /// Copies the state of a lane to its slot.
    #[inline]
    fn copy_state(&self, lane: usize, slot: &mut Slot) {
        let phase = &mut slot.phase;
        phase.state = self.state.map(|block| block[lane]);
        phase.now.state = self.rates.map(|block| block[lane]);
        phase.now.press = self.press[lane];
        phase.now.jam_margin = self.jam_margin[lane];
        slot.usage.steps = count(self.steps[lane]);
        slot.usage.time = self.time[lane];
    }

    /// What the last try of a lane leads to; `None` if its tilt search needs another try.
    #[inline]
    fn after_try(
        &self,
        solver: &mut ContactSolver<'_>,
        lane: usize,
        slot: &mut Slot,
    ) -> Option<PhaseTransition> {
        let phase = &mut slot.phase;
        let (motion, spin) = (&mut slot.toss.motion, &mut slot.toss.spin);
        let state = || self.trial.state.map(|block| block[lane]);
        if slot.tilt_search.is_none() && has(self.allowed & self.eventful, lane) {
            slot.tilt_search =
                TiltSearch::within(phase, &state(), self.length[lane], solver.rules.side);
        }
        if let Some(mut search) = slot.tilt_search {
            let state = state();
            if search.needs_another_try(&state) {
                slot.tilt_search = Some(search);
                return None;
            }
            slot.tilt_search = None;
            let (next, length) = search.finish(phase, state);
            solver.move_to_phase(phase, length, motion, spin);
            return Some(next);
        }
        Some(if !has(self.allowed, lane) {
            solver.give_up(phase, motion, spin)
        } else if has(self.eventful, lane) {
            let (trial, now) = (self.trial.lane(lane), self.now.lane(lane));
            let (length, wanted) = (self.length[lane], self.wanted[lane]);
            let (next, length) = solver.accept(phase, &trial, &now, length, wanted);
            solver.move_to_phase(phase, length, motion, spin);
            next
        } else {
            phase.length = self.length[lane];
            place(solver.rules.dynamics, &phase.state, motion, spin);
            PhaseTransition::Stay
        })
    }

    /// Keeps a trial step for the scalar path to examine.
    #[inline(always)]
    fn keep_trial<L: Wide>(&mut self, trial: &Trial<L, 6>, rates: &Rates<L>) {
        let (now, kept) = (&mut self.now, &mut self.trial);
        store(&mut now.state, &rates.state);
        store(&mut now.friction, &rates.friction);
        now.normal = rates.normal.store();
        now.press = rates.press.store();
        now.jam_margin = rates.jam_margin.store();
        store(&mut kept.state, &trial.state);
        (kept.error, kept.h) = (trial.error.store(), trial.h.store());
        for (kept, stage) in kept.stages.iter_mut().zip(&trial.stages) {
            store(kept, stage);
        }
    }
}

impl<const N: usize> Trial<Block, N> {
    fn lane(&self, lane: usize) -> Trial<f64, N> {
        let numbers = |blocks: &[Block; N]| blocks.map(|block| block[lane]);
        Trial {
            state: numbers(&self.state),
            error: self.error[lane],
            h: self.h[lane],
            stages: std::array::from_fn(|i| numbers(&self.stages[i])),
        }
    }
}

impl Rates<Block> {
    fn lane(&self, lane: usize) -> Rates<f64> {
        Rates {
            state: self.state.map(|block| block[lane]),
            normal: self.normal[lane],
            friction: self.friction.map(|block| block[lane]),
            press: self.press[lane],
            jam_margin: self.jam_margin[lane],
        }
    }
}

// not generic over impact laws, so that it is compiled once
fn try_steps(stage: &mut ContactStage, lanes: Lanes, rules: ContactRules<'_>, mode: Mode) {
    // friction that holds is rare: one variant serves it with drag and without
    let (drags, holds) = (rules.dynamics.drags_or_rounds(), rules.dynamics.holds());
    match (mode, drags, holds) {
        (Mode::Stick, false, false) => lanes.enter(TrySteps::<true, false, false> { stage, rules }),
        (Mode::Slip, false, false) => lanes.enter(TrySteps::<false, false, false> { stage, rules }),
        (Mode::Stick, true, false) => lanes.enter(TrySteps::<true, true, false> { stage, rules }),
        (Mode::Slip, true, false) => lanes.enter(TrySteps::<false, true, false> { stage, rules }),
        (Mode::Stick, _, true) => lanes.enter(TrySteps::<true, true, true> { stage, rules }),
        (Mode::Slip, _, true) => lanes.enter(TrySteps::<false, true, true> { stage, rules }),
    }
}

/// One try in each lane, of coins that stick or of coins that slip.
struct TrySteps<'a, const STICKS: bool, const DRAGS: bool, const HOLDS: bool> {
    stage: &'a mut ContactStage,
    rules: ContactRules<'a>,
}

impl<const STICKS: bool, const DRAGS: bool, const HOLDS: bool> Work
    for TrySteps<'_, STICKS, DRAGS, HOLDS>
{
    type Output = ();

    #[inline(always)]
    fn run<L: Wide>(self) {
        let (stage, rules) = (self.stage, &self.rules);
        let mode = if STICKS { Mode::Stick } else { Mode::Slip };
        let state = load::<L, 6>(&stage.state);
        let rates = load::<L, 6>(&stage.rates);
        let step = StepTrial {
            state,
            rates,
            length: L::load(&stage.length),
            ceiling: L::load(&stage.ceiling),
            retry: L::mask(stage.retry),
        };
        let dynamics = rules.dynamics.with_known::<DRAGS, HOLDS>();
        let tried = step.run(&dynamics, rules, mode);
        let steps = L::load(&stage.steps) + L::splat(1.0);
        let allowed = rules.limits.allow_step(tried.length, steps);
        let open = allowed & !L::mask(stage.searching);
        let calm = open & tried.accepted & !tried.eventful;
        let retries = open & !tried.accepted;
        let time = L::load(&stage.time);
        let time = L::select(calm, time + tried.length, time);
        let goes_on = calm & !tried.decided & !rules.limits.is_late(time);

        stage.steps = steps.store();
        stage.time = time.store();
        let length = L::select(calm | retries, tried.wanted, tried.length);
        stage.length = length.store();
        stage.wanted = tried.wanted.store();
        for i in 0..6 {
            stage.state[i] = L::select(calm, tried.state[i], state[i]).store();
            stage.rates[i] = L::select(calm, tried.now.state[i], rates[i]).store();
        }
        let (press, margin) = (L::load(&stage.press), L::load(&stage.jam_margin));
        stage.press = L::select(calm, tried.now.press, press).store();
        stage.jam_margin = L::select(calm, tried.now.jam_margin, margin).store();
        stage.retry = L::bits(retries);
        stage.allowed = L::bits(allowed);
        stage.eventful = L::bits(tried.eventful);
        stage.attention = stage.occupied & !L::bits(goes_on | retries);
        if stage.attention & (stage.eventful | stage.searching) != 0 {
            stage.keep_trial(&tried.trial, &tried.now);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Usage;

    fn slot() -> Slot {
        let mut slot = Slot::empty();
        slot.phase.state = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6];
        slot.phase.now.state = [1.1, 1.2, 1.3, 1.4, 1.5, 1.6];
        (slot.phase.now.press, slot.phase.now.jam_margin) = (2.1, 2.2);
        (slot.phase.length, slot.phase.ceiling) = (3.1, 3.2);
        slot.usage = Usage {
            steps: 41,
            jams: 5,
            time: 6.1,
        };
        slot
    }

    /// A lane holds what its coin was put in with, and nothing of the coin before it; the other lanes keep their own.
    #[test]
    fn a_lane_belongs_to_the_coin_that_is_put_there() {
        let search = TiltSearch::within(&slot().phase, &[2.0; 6], 0.7, 1.5);
        assert!(search.is_some());
        let searching = Slot {
            tilt_search: search,
            ..slot()
        };
        for lane in 0..WIDTH {
            let bit = 1 << lane;
            let mut stage = ContactStage::new();
            (stage.retry, stage.searching, stage.occupied) = (Bits::MAX, Bits::MAX, 0b0110);
            stage.put(lane, 9, &slot());
            assert_eq!((stage.retry, stage.searching), (!bit, !bit));
            assert_eq!(stage.free(), !(0b0110 | bit));
            assert_eq!((stage.slot(lane), stage.length[lane]), (9, 3.1));
            stage.put(lane, 9, &searching);
            assert_eq!((stage.retry, stage.searching), (Bits::MAX, Bits::MAX));
            (stage.retry, stage.searching) = (0, 0);
            stage.put(lane, 9, &searching);
            assert_eq!((stage.retry, stage.searching), (bit, bit));
            assert_eq!(stage.length[lane], 0.7);
            assert_eq!(stage.ceiling[lane], 3.2);
            let mut copy = Slot::empty();
            stage.copy_state(lane, &mut copy);
            let (phase, expected) = (&copy.phase, &slot().phase);
            assert_eq!(phase.state, expected.state);
            assert_eq!(phase.now.state, expected.now.state);
            assert_eq!((phase.now.press, phase.now.jam_margin), (2.1, 2.2));
            assert_eq!((copy.usage.steps, copy.usage.time), (41, 6.1));
        }
        let mut stage = ContactStage::new();
        stage.occupied = 0b1011;
        assert_eq!(stage.load(&[7, 8]), 5);
    }
}

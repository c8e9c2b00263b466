//! Eight coins in sustained contact in one mode: attempt after attempt at steps of each, until
//! something happens to one.

use super::pool::Slot;
use crate::contact::attempt::Attempt;
use crate::contact::integrator::{LEAST_STEP, Trial};
use crate::contact::rim::{Mode, Rates};
use crate::contact::state::place;
use crate::contact::{Law, Next, Reach};
use crate::engine::{Onward, VolumetricEngine};
use crate::flight::{load, store};
use crate::impact::ImpactLaw;
use crate::settings::Settings;
use coinmc_core::DecisionRule;
use coinmc_lanes::Lanes;
use coinmc_lanes::{Bits, Block, WIDTH, Wide, Work};

const NONE: Block = [0.0; WIDTH];

/// Blocks first, each in a line of the cache.
#[repr(C, align(64))]
pub(super) struct Station {
    state: [Block; 6],
    rates: [Block; 6],
    press: Block,
    yields: Block,
    ceiling: Block,
    /// Of the next step, or where `again` of the next attempt at it.
    length: Block,
    steps: Block,
    time: Block,
    /// Of the last attempt: the length that it wants next, and what it found.
    wanted: Block,
    now: Rates<Block>,
    trial: Trial<Block, 6>,
    pub(super) owner: [usize; WIDTH],
    pub(super) occupied: Bits,
    /// Coins that cannot go on without being looked at alone.
    pub(super) attention: Bits,
    again: Bits,
    /// On the search for where a point comes down: attempts of a given length.
    reaching: Bits,
    /// Of the last attempt: whether it might be made, and whether something happens within it.
    may: Bits,
    eventful: Bits,
}

/// A count that is held as a float.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn count(steps: f64) -> u32 {
    // from 0 to the limit of a u32, where the cast saturates
    steps as u32
}

fn has(bits: Bits, lane: usize) -> bool {
    bits & (1 << lane) != 0
}

impl Station {
    pub(super) fn new() -> Self {
        Self {
            owner: [0; WIDTH],
            occupied: 0,
            attention: 0,
            state: [NONE; 6],
            rates: [NONE; 6],
            press: NONE,
            yields: NONE,
            ceiling: NONE,
            length: NONE,
            again: 0,
            reaching: 0,
            steps: NONE,
            time: NONE,
            may: 0,
            eventful: 0,
            wanted: NONE,
            now: Rates {
                state: [NONE; 6],
                normal: NONE,
                friction: [NONE; 2],
                press: NONE,
                yields: NONE,
            },
            trial: Trial {
                state: [NONE; 6],
                error: NONE,
                h: NONE,
                stages: [[NONE; 6]; 6],
            },
        }
    }

    /// How many coins are here or wait for a place.
    pub(super) fn with(&self, waiting: &[usize]) -> usize {
        self.occupied.count_ones() as usize + waiting.len()
    }

    /// Takes over a coin in contact.
    #[inline]
    pub(super) fn put(&mut self, lane: usize, owner: usize, slot: &Slot) {
        let phase = &slot.phase;
        self.owner[lane] = owner;
        self.occupied |= 1 << lane;
        for (block, number) in self.state.iter_mut().zip(phase.state) {
            block[lane] = number;
        }
        for (block, number) in self.rates.iter_mut().zip(phase.now.state) {
            block[lane] = number;
        }
        self.press[lane] = phase.now.press;
        self.yields[lane] = phase.now.yields;
        self.ceiling[lane] = phase.ceiling;
        self.length[lane] = slot.reach.map_or(phase.length, |reach| reach.length);
        let reaching = Bits::from(slot.reach.is_some()) << lane;
        self.again = (self.again & !(1 << lane)) | reaching;
        self.reaching = (self.reaching & !(1 << lane)) | reaching;
        self.steps[lane] = f64::from(slot.spent.steps);
        self.time[lane] = slot.spent.time;
    }

    /// Makes the attempts.
    pub(super) fn make<L: ImpactLaw>(&mut self, engine: &VolumetricEngine<L>, mode: Mode) {
        let terms = Terms {
            law: &engine.contact,
            rule: &engine.rule,
            settings: &engine.settings,
            tolerance: engine.tolerance,
        };
        make(self, engine.lanes, terms, mode);
    }

    /// Lets go of a coin that something happens to, and sees to that; `None` if its contact goes
    /// on.
    pub(super) fn conclude<L: ImpactLaw>(
        &mut self,
        engine: &VolumetricEngine<L>,
        lane: usize,
        slot: &mut Slot,
    ) -> Option<Onward> {
        self.occupied &= !(1 << lane);
        let phase = &mut slot.phase;
        phase.state = self.state.map(|block| block[lane]);
        phase.now.state = self.rates.map(|block| block[lane]);
        (phase.now.press, phase.now.yields) = (self.press[lane], self.yields[lane]);
        slot.spent.steps = count(self.steps[lane]);
        slot.spent.time = self.time[lane];
        let mut contact = engine.contact_of(slot.spent);
        let (motion, spin) = (&mut slot.toss.motion, &mut slot.toss.spin);
        let state = || self.trial.state.map(|block| block[lane]);
        if slot.reach.is_none() && has(self.may & self.eventful, lane) {
            slot.reach = Reach::of(phase, &state(), self.length[lane]);
        }
        let next = if let Some(mut reach) = slot.reach {
            let state = state();
            if reach.is_away(&state) {
                slot.reach = Some(reach);
                return None;
            }
            slot.reach = None;
            let (next, length) = reach.arrive(phase, state);
            contact.move_on(phase, length, motion, spin);
            next
        } else if !has(self.may, lane) {
            contact.give_up(phase, motion, spin)
        } else if has(self.eventful, lane) {
            let (trial, now) = (self.trial.lane(lane), self.now.lane(lane));
            let (length, wanted) = (self.length[lane], self.wanted[lane]);
            let (next, length) = contact.accept(phase, &trial, &now, length, wanted);
            contact.move_on(phase, length, motion, spin);
            next
        } else {
            phase.length = self.length[lane];
            place(&engine.contact, &phase.state, motion, spin);
            Next::Go
        };
        let mut leave = contact.go_on(next, phase, motion, spin);
        if leave.is_none() {
            leave = contact.poise(phase, motion, spin);
        }
        slot.spent = contact.spent;
        leave.map(|leave| engine.onward(&mut slot.toss, leave))
    }
}

impl<const N: usize> Trial<Block, N> {
    fn lane(&self, lane: usize) -> Trial<f64, N> {
        let of = |blocks: &[Block; N]| blocks.map(|block| block[lane]);
        Trial {
            state: of(&self.state),
            error: self.error[lane],
            h: self.h[lane],
            stages: std::array::from_fn(|i| of(&self.stages[i])),
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
            yields: self.yields[lane],
        }
    }
}

/// What governs an attempt.
#[derive(Clone, Copy)]
struct Terms<'a> {
    law: &'a Law,
    rule: &'a DecisionRule,
    settings: &'a Settings,
    tolerance: f64,
}

// apart from the laws of impact, so that it is compiled once
fn make(station: &mut Station, lanes: Lanes, terms: Terms<'_>, mode: Mode) {
    match (mode, terms.law.drag.acts()) {
        (Mode::Stick, false) => lanes.enter(Make::<true, false> { station, terms }),
        (Mode::Slip, false) => lanes.enter(Make::<false, false> { station, terms }),
        (Mode::Stick, true) => lanes.enter(Make::<true, true> { station, terms }),
        (Mode::Slip, true) => lanes.enter(Make::<false, true> { station, terms }),
    }
}

/// Attempts of coins that stick, or that slip.
struct Make<'a, const STICKS: bool, const DRAGS: bool> {
    station: &'a mut Station,
    terms: Terms<'a>,
}

impl<const STICKS: bool, const DRAGS: bool> Work for Make<'_, STICKS, DRAGS> {
    type Output = ();

    #[inline(always)]
    fn run<L: Wide>(self) {
        let (station, terms) = (self.station, &self.terms);
        let mode = if STICKS { Mode::Stick } else { Mode::Slip };
        let state = load::<L, 6>(&station.state);
        let rates = load::<L, 6>(&station.rates);
        let attempt = Attempt {
            state,
            rates,
            length: L::load(&station.length),
            ceiling: L::load(&station.ceiling),
            again: L::mask(station.again),
        };
        let settings = terms.settings;
        let law = terms.law.with_known_drag::<DRAGS>();
        let made = attempt.make(
            &law,
            terms.rule,
            terms.tolerance,
            settings.stick_speed,
            mode,
        );
        let steps = L::load(&station.steps) + L::splat(1.0);
        let last = L::splat(f64::from(settings.max_steps)).le(steps);
        let may = !(made.length.lt(L::splat(LEAST_STEP)) | last);
        let tries = may & !L::mask(station.reaching);
        let calm = tries & made.accepted & !made.eventful;
        let retries = tries & !made.accepted;
        let time = L::load(&station.time);
        let time = L::select(calm, time + made.length, time);
        let late = L::splat(settings.time_limit).lt(time);
        let goes_on = calm & !made.decided & !late;

        station.steps = steps.store();
        station.time = time.store();
        let length = L::select(calm | retries, made.wanted, made.length);
        station.length = length.store();
        station.wanted = made.wanted.store();
        for i in 0..6 {
            station.state[i] = L::select(calm, made.state[i], state[i]).store();
            station.rates[i] = L::select(calm, made.now.state[i], rates[i]).store();
        }
        let (press, yields) = (L::load(&station.press), L::load(&station.yields));
        station.press = L::select(calm, made.now.press, press).store();
        station.yields = L::select(calm, made.now.yields, yields).store();
        station.again = L::bits(retries);
        station.may = L::bits(may);
        station.eventful = L::bits(made.eventful);
        station.attention = station.occupied & !L::bits(goes_on | retries);
        if station.attention & (station.eventful | station.reaching) != 0 {
            station.keep(&made.trial, &made.now);
        }
    }
}

impl Station {
    /// Keeps a trial for who looks into it.
    #[inline(always)]
    fn keep<L: Wide>(&mut self, trial: &Trial<L, 6>, rates: &Rates<L>) {
        let (now, kept) = (&mut self.now, &mut self.trial);
        store(&mut now.state, &rates.state);
        store(&mut now.friction, &rates.friction);
        now.normal = rates.normal.store();
        now.press = rates.press.store();
        now.yields = rates.yields.store();
        store(&mut kept.state, &trial.state);
        (kept.error, kept.h) = (trial.error.store(), trial.h.store());
        for (kept, stage) in kept.stages.iter_mut().zip(&trial.stages) {
            store(kept, stage);
        }
    }
}

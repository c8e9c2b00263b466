//! Many tosses side by side: the same toss as [`engine`](crate::engine)'s, eight at a time.
//!
//! ```text
//! launches ─▶ departing ─▶ on search ─▶ landed ─▶ struck ─▶ on search
//!                                                   │
//!                         once more, for what was not the last bounce: struck
//!                         sticking, slipping: departing, struck, ended
//! ```
//!
//! A pool of tosses is in flight. Each is at one stage, and a stage is done for eight of them at
//! once as soon as eight are there: lanes are full whatever the tosses have before them. On search
//! and in contact a toss keeps its lane from step to step, and a lane that is done is given to the
//! next toss. What is rare (a coin that lies, stands, jams, changes its mode of contact) is
//! done alone by the code of the single toss, and so is all of it where lanes are
//! [`Scalar`](Lanes::Scalar).
//!
//! No lane sees another and every operation is IEEE 754's, so a toss has the same outcome to the
//! last bit beside whatever others, and with any instruction set.

mod contact;
mod pool;
mod struck;

#[cfg(test)]
mod tests;

use crate::contact::rim::Mode;
use crate::engine::{Finished, Onward, VolumetricEngine};
use crate::impact::ImpactLaw;
use coinmc_core::{Ended, Landing, Launch, TossBatch};
use coinmc_lanes::Lanes;
use coinmc_lanes::{Bits, WIDTH, first, lanes_of};
use pool::{Pool, SLOTS};

pub(crate) struct Batch<'a, L> {
    engine: &'a VolumetricEngine<L>,
    pool: Pool,
    launched: u64,
    /// Tosses that have ended and are yet to be told, by number.
    ended: Vec<(u64, Finished)>,
}

impl<'a, L: ImpactLaw> Batch<'a, L> {
    /// `None` for an engine whose tosses are followed one after the other.
    pub(crate) fn of(engine: &'a VolumetricEngine<L>) -> Option<Self> {
        (engine.lanes != Lanes::Scalar).then(|| Self {
            engine,
            pool: Pool::new(),
            launched: 0,
            ended: Vec::with_capacity(2 * SLOTS),
        })
    }
}

impl<L: ImpactLaw> TossBatch for Batch<'_, L> {
    type End = Finished;

    fn has_room(&self) -> bool {
        !self.pool.free.is_empty() && self.ended.len() < SLOTS
    }

    /// Launches a toss into a free slot.
    fn launch(&mut self, launch: &Launch) {
        let Some(slot) = self.pool.free.pop() else {
            // never: whoever launches sees to the room first
            return;
        };
        let toss = self.engine.launched(launch);
        self.pool.slots[slot].begin(self.launched, toss);
        self.launched += 1;
        match self.engine.ends_at_launch(&toss, launch) {
            Some(ended) => self.end(slot, ended),
            None => self.pool.departing.push(slot),
        }
    }

    /// One piece of work: of eight tosses if eight are at any one stage, else of as many as there
    /// are. `false` if nothing is left to do.
    fn advance(&mut self) -> bool {
        let pool = &self.pool;
        if pool.searching.landed() >= WIDTH {
            self.bounce();
        } else if pool.departing.len() >= WIDTH && pool.searching.vacant() >= WIDTH {
            self.depart();
        } else if pool.again.len() >= WIDTH && pool.searching.vacant() >= WIDTH {
            self.strike_again();
        } else if pool.slips.with(&pool.slipping) >= WIDTH {
            self.attempt(Mode::Slip);
        } else if pool.sticks.with(&pool.sticking) >= WIDTH {
            self.attempt(Mode::Stick);
        } else if pool.searching.is_any() {
            self.sweep();
        } else if pool.searching.landed() > 0 {
            self.bounce();
        } else if !pool.again.is_empty() {
            self.strike_again();
        } else if !pool.departing.is_empty() {
            self.depart();
        } else if pool.slips.with(&pool.slipping) > 0 {
            self.attempt(Mode::Slip);
        } else if pool.sticks.with(&pool.sticking) > 0 {
            self.attempt(Mode::Stick);
        } else {
            return false;
        }
        true
    }

    fn ended(&mut self) -> &mut Vec<(u64, Finished)> {
        &mut self.ended
    }
}

impl<L: ImpactLaw> Batch<'_, L> {
    fn end(&mut self, slot: usize, ended: Ended) {
        let of = &self.pool.slots[slot];
        let finished = Finished::new(ended, &of.toss, &of.spent);
        self.ended.push((of.number, finished));
        self.pool.free.push(slot);
    }

    /// Puts flights on search.
    fn depart(&mut self) {
        let (law, pool) = (&self.engine.contact, &mut self.pool);
        let count = pool.departing.len().min(WIDTH);
        let from = pool.departing.len() - count;
        let begin = &mut pool.begin;
        (begin.launched, begin.parting) = (0, 0);
        for lane in 0..WIDTH {
            // beyond the last, lanes do the same as the first, for nothing
            let owner = pool.departing[from + if lane < count { lane } else { 0 }];
            let slot = &pool.slots[owner];
            begin.put(lane, owner, &slot.toss.motion, &slot.toss.spin);
            begin.launched |= Bits::from(slot.launched) << lane;
            begin.parting |= Bits::from(slot.parting) << lane;
        }
        pool.departing.truncate(from);
        let (lanes, flies) = (self.engine.lanes, first(count));
        pool.searching
            .depart(lanes, &law.body, law.drag, &pool.begin, flies);
    }

    /// One step of every flight on search.
    fn sweep(&mut self) {
        let law = &self.engine.contact;
        let searching = &mut self.pool.searching;
        searching.sweep(self.engine.lanes, &law.body, law.drag);
    }

    /// Lands flights and throws the coins back.
    fn bounce(&mut self) {
        let (engine, pool) = (self.engine, &mut self.pool);
        let searching = &mut pool.searching;
        let count = pool.struck.land(engine.lanes, &engine.contact, searching);
        let mut aside = pool.struck.unusual();
        for lane in 0..count {
            let slot = &mut pool.slots[pool.struck.owner(lane)];
            pool.struck.bring_down(lane, slot);
            let late = slot.spent.time > engine.settings.time_limit;
            let last = slot.toss.impacts == engine.settings.max_impacts;
            aside |= Bits::from(late | last) << lane;
        }
        if !L::SIDE_BY_SIDE || engine.landing == Landing::Adhesive {
            aside = Bits::MAX;
        }
        for lane in lanes_of(aside & first(count)) {
            let onward = self.without_impact(lane);
            self.go(self.pool.struck.owner(lane), onward);
        }
        let open = first(count) & !aside;
        if open != 0 {
            self.strike(open, true);
        }
    }

    /// Throws back coins whose last bounce this was not.
    fn strike_again(&mut self) {
        let pool = &mut self.pool;
        let count = pool.again.len().min(WIDTH);
        let from = pool.again.len() - count;
        for at in 0..WIDTH {
            let owner = pool.again[from + if at < count { at } else { 0 }];
            pool.struck.gather(at, owner, &pool.slots[owner].toss);
        }
        pool.again.truncate(from);
        self.strike(first(count), false);
    }

    /// Throws coins back, those of `open`.
    fn strike(&mut self, open: Bits, may_end: bool) {
        let (engine, law) = (self.engine, &self.engine.contact);
        let pool = &mut self.pool;
        pool.struck.strike(engine, may_end);
        let again = open & pool.struck.again();
        for lane in 0..WIDTH {
            // the last lanes may repeat the first, and are not open
            let slot = &mut pool.slots[pool.struck.owner(lane)];
            slot.toss.impacts += u32::from(((open & !again) >> lane) & 1);
        }
        for lane in lanes_of(again) {
            let owner = pool.struck.owner(lane);
            pool.struck.scatter(lane, &mut pool.slots[owner].toss);
            pool.again.push(owner);
        }
        let mut flies = open & pool.struck.flies();
        for lane in lanes_of(open & !again & !flies) {
            let pool = &mut self.pool;
            let owner = pool.struck.owner(lane);
            match pool.struck.rebound(engine, lane, &mut pool.slots[owner]) {
                Onward::Fly(false) => flies |= 1 << lane,
                onward => self.go(owner, onward),
            }
        }
        if flies == 0 {
            return;
        }
        let (pool, lanes) = (&mut self.pool, engine.lanes);
        let begin = &pool.struck.after;
        pool.searching
            .depart(lanes, &law.body, law.drag, begin, flies);
    }

    /// What a landed coin does instead of an impact of its own lane.
    fn without_impact(&mut self, lane: usize) -> Onward {
        let (engine, struck) = (self.engine, &self.pool.struck);
        let slot = &mut self.pool.slots[struck.owner(lane)];
        if struck.is_lost(lane) {
            struck.restore(lane, &mut slot.toss, engine.contact.axial_factor);
            return Onward::End(engine.lost(&slot.toss));
        }
        struck.scatter(lane, &mut slot.toss);
        if slot.spent.time > engine.settings.time_limit {
            Onward::End(Ended::TimeLimit)
        } else if engine.landing == Landing::Adhesive {
            Onward::End(engine.stuck(&slot.toss))
        } else {
            Onward::Strike
        }
    }

    /// One attempt at a step of sustained contact.
    fn attempt(&mut self, mode: Mode) {
        let engine = self.engine;
        let pool = &mut self.pool;
        let (station, waiting) = match mode {
            Mode::Slip => (&mut pool.slips, &mut pool.slipping),
            Mode::Stick => (&mut pool.sticks, &mut pool.sticking),
        };
        for lane in lanes_of(!station.occupied) {
            let Some(owner) = waiting.pop() else {
                break;
            };
            station.put(lane, owner, &pool.slots[owner]);
        }
        station.make(engine, mode);
        let attention = station.attention;
        for lane in lanes_of(attention) {
            let pool = &mut self.pool;
            let station = match mode {
                Mode::Slip => &mut pool.slips,
                Mode::Stick => &mut pool.sticks,
            };
            let owner = station.owner[lane];
            match station.conclude(engine, lane, &mut pool.slots[owner]) {
                None => pool.in_contact(owner),
                Some(onward) => self.go(owner, onward),
            }
        }
    }

    /// Brings a toss to its next stage.
    fn go(&mut self, slot: usize, mut onward: Onward) {
        loop {
            let of = &mut self.pool.slots[slot];
            let mut contact = self.engine.contact_of(of.spent);
            onward = match onward {
                Onward::Fly(parting) => {
                    (of.parting, of.launched) = (parting, false);
                    self.pool.departing.push(slot);
                    return;
                }
                Onward::End(ended) => {
                    self.end(slot, ended);
                    return;
                }
                Onward::Strike => self.engine.impact(&mut of.toss, &mut contact, &mut ()),
                Onward::Sustain => {
                    let (motion, spin) = (&mut of.toss.motion, &mut of.toss.spin);
                    of.phase = contact.start(motion, spin);
                    match contact.poise(&mut of.phase, motion, spin) {
                        None => {
                            of.spent = contact.spent;
                            self.pool.in_contact(slot);
                            return;
                        }
                        Some(leave) => self.engine.onward(&mut of.toss, leave),
                    }
                }
            };
            of.spent = contact.spent;
        }
    }
}

//! Eight coins that have come down: the end of their flights and their impacts.

use super::pool::Slot;
use crate::aloft::land;
use crate::contact::{FLAT, Law};
use crate::engine::{Onward, VolumetricEngine};
use crate::flight::{Departing, Leavers, MOTION, Searching};
use crate::impact::ImpactLaw;
use crate::motion::{Motion, Spin};
use crate::rest;
use crate::toss::Toss;
use coinmc_core::Decided;
use coinmc_lanes::Lanes;
use coinmc_lanes::{Bits, Block, Wide, Work};

#[derive(Debug, Clone, Default)]
#[repr(C, align(64))]
pub(super) struct StruckTosses {
    pub(super) leavers: Leavers,
    /// Motions and axial spins, as flights begin with them; of a landing and then of an impact.
    pub(super) after: Departing,
    turn: Block,
    tilt: Block,
    /// Duration of the flight.
    took: Block,
    reflected: Bits,
    lost: Bits,
    level: Bits,
    /// Whose impact may be the last; who has to be struck anew because it was not.
    may_end: Bits,
    again: Bits,
    sustains: Bits,
    parts: Bits,
    decided: Bits,
    on_side: Bits,
    /// All but on its side or a face: what follows is decided alone.
    extreme: Bits,
}

fn has(bits: Bits, lane: usize) -> bool {
    bits & (1 << lane) != 0
}

impl StruckTosses {
    /// Ends up to eight flights; how many.
    pub(super) fn land(&mut self, lanes: Lanes, law: &Law, searching: &mut Searching) -> usize {
        let tosses = self;
        if law.drag.acts() {
            lanes.enter(Land::<true> {
                tosses,
                searching,
                law,
            })
        } else {
            lanes.enter(Land::<false> {
                tosses,
                searching,
                law,
            })
        }
    }

    /// Ends the flight of a toss, but for its motion.
    #[inline]
    pub(super) fn bring_down(&self, lane: usize, slot: &mut Slot) {
        slot.toss.in_turn = 0;
        slot.spent.time += self.took[lane];
        slot.toss.heads_up ^= has(self.reflected, lane);
    }

    /// Takes over a landed coin.
    #[inline]
    pub(super) fn gather(&mut self, lane: usize, owner: usize, toss: &Toss) {
        self.after.put(lane, owner, &toss.motion, &toss.spin);
        (self.turn[lane], self.tilt[lane]) = (toss.spin.turn, toss.spin.tilt);
    }

    /// Whose lane it is.
    pub(super) fn owner(&self, lane: usize) -> usize {
        self.after.owners.of(lane)
    }

    /// Coins whose impact was not the last, and so has not been.
    pub(super) fn again(&self) -> Bits {
        self.again
    }

    /// Coins whose flight was lost, or that are all but level.
    pub(super) fn unusual(&self) -> Bits {
        self.lost | self.level
    }

    /// Coins that an impact sends into a flight like most.
    pub(super) fn flies(&self) -> Bits {
        !(self.again | self.decided | self.sustains | self.parts | self.extreme)
    }

    /// Hands a motion to its toss.
    #[inline]
    pub(super) fn scatter(&self, lane: usize, toss: &mut Toss) {
        let [motion @ .., axial] = &self.after.motion;
        toss.motion = Motion::of(&motion.map(|block| block[lane]));
        toss.spin = Spin::of(&[axial[lane], self.turn[lane], self.tilt[lane]]);
    }

    /// Hands a toss the motion with which its flight began.
    pub(super) fn restore(&self, lane: usize, toss: &mut Toss, axial_factor: f64) {
        toss.motion = self.leavers.start(lane);
        toss.spin = toss.motion.spin(axial_factor);
    }

    pub(super) fn is_lost(&self, lane: usize) -> bool {
        has(self.lost, lane)
    }

    /// Throws the coins back.
    pub(super) fn strike<L: ImpactLaw>(&mut self, engine: &VolumetricEngine<L>, may_end: bool) {
        self.may_end = if may_end { Bits::MAX } else { 0 };
        engine.lanes.enter(Strike {
            tosses: self,
            engine,
        });
    }

    /// What follows an impact that does not send the coin into a flight like most; unless it is one
    /// after all, the toss has its motion.
    #[inline]
    pub(super) fn rebound<L: ImpactLaw>(
        &self,
        engine: &VolumetricEngine<L>,
        lane: usize,
        slot: &mut Slot,
    ) -> Onward {
        let toss = &mut slot.toss;
        if has(self.decided, lane) {
            let well = if has(self.on_side, lane) {
                Decided::Side
            } else {
                Decided::Face
            };
            return Onward::End(toss.ended(well));
        }
        let after = if has(self.sustains, lane) {
            Onward::Sustain
        } else {
            Onward::Fly(has(self.parts, lane))
        };
        self.scatter(lane, toss);
        if !has(self.extreme, lane) {
            return after;
        }
        let mut contact = engine.contact_of(slot.spent);
        let onward = engine.after_impact(toss, after, &mut contact, &mut ());
        slot.spent = contact.spent;
        onward
    }
}

impl StruckTosses {
    #[inline(always)]
    fn set<L: Wide>(&mut self, motion: &Motion<L>, spin: &Spin<L>) {
        let blocks = &mut self.after.motion;
        for (block, lanes) in blocks.iter_mut().zip(motion.numbers()) {
            *block = lanes.store();
        }
        blocks[MOTION - 1] = spin.axial.store();
        self.turn = spin.turn.store();
        self.tilt = spin.tilt.store();
    }

    #[inline(always)]
    fn now<L: Wide>(&self) -> (Motion<L>, Spin<L>) {
        let (motion, axial) = self.after.load::<L>();
        let spin = Spin {
            axial,
            turn: L::load(&self.turn),
            tilt: L::load(&self.tilt),
        };
        (motion, spin)
    }
}

struct Land<'a, const DRAGS: bool> {
    tosses: &'a mut StruckTosses,
    searching: &'a mut Searching,
    law: &'a Law,
}

impl<const DRAGS: bool> Work for Land<'_, DRAGS> {
    type Output = usize;

    #[inline(always)]
    fn run<L: Wide>(self) -> usize {
        let (tosses, law) = (self.tosses, self.law);
        let count = self.searching.gather::<L>(&mut tosses.leavers);
        tosses.after.owners = tosses.leavers.owners;
        let orbit = tosses.leavers.orbit::<L>(law.drag.known::<DRAGS>());
        let (time, lost) = tosses.leavers.close_in(&orbit, &law.body);
        let (motion, axial) = tosses.leavers.motion::<L>();
        let landed = land(law, &orbit, &motion, axial, time);
        tosses.set(&landed.motion, &landed.spin);
        tosses.lost = L::bits(lost);
        // a toss whose flight is lost ends where that began
        tosses.took = L::select(lost, L::splat(0.0), orbit.since_start(time)).store();
        tosses.reflected = L::bits(landed.reflected) & !tosses.lost;
        tosses.level = L::bits(landed.motion.sin.le(L::splat(FLAT)));
        count
    }
}

struct Strike<'a, I> {
    tosses: &'a mut StruckTosses,
    engine: &'a VolumetricEngine<I>,
}

impl<I: ImpactLaw> Work for Strike<'_, I> {
    type Output = ();

    #[inline(always)]
    fn run<L: Wide>(self) {
        let (tosses, engine) = (self.tosses, self.engine);
        let (landed, falling) = tosses.now::<L>();
        let struck = engine.strike(&landed, &falling, L::mask(tosses.may_end));
        tosses.again = L::bits(struck.again);
        let motion = &struck.motion;
        // a coin to be struck anew keeps the motion it came down with
        let kept = Motion::select(struck.again, &landed, motion);
        tosses.set(&kept, &Spin::select(struck.again, &falling, &struck.spin));
        tosses.sustains = L::bits(struck.sustains);
        tosses.parts = L::bits(struck.parts);
        let body = &engine.contact.body;
        let state = motion.decision_state(body, &struck.spin);
        tosses.decided = L::bits(engine.rule.is_decided(&state));
        tosses.on_side = L::bits(engine.rule.on_side(motion.cos));
        let small = rest::ROCKING * engine.settings.zeno;
        let lies = motion.cos.lt(L::splat(small * body.half));
        let stands = motion.sin.le(L::splat((small * body.radius).max(FLAT)));
        tosses.extreme = L::bits(lies | stands);
    }
}

//! The tosses that are on their way, and the stage each is at.

use super::contact::Station;
use super::struck::StruckTosses;
use crate::contact::rim::Mode;
use crate::contact::{Phase, Reach, Spent};
use crate::flight::{Departing, Searching};
use crate::toss::Toss;

/// Tosses on their way: enough that eight are nearly always at one stage. From 64 to 256 the speed
/// is the same within 5 %.
pub(super) const SLOTS: usize = 128;

/// A toss. What a flight and an impact need of it is in one line of the cache, its first.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
pub(super) struct Slot {
    pub(super) spent: Spent,
    /// Its number among the launches.
    pub(super) number: u64,
    /// How its next flight begins.
    pub(super) launched: bool,
    pub(super) parting: bool,
    pub(super) toss: Toss,
    pub(super) phase: Phase,
    /// On the search for the end of contact.
    pub(super) reach: Option<Reach>,
}

impl Slot {
    fn empty() -> Self {
        Self {
            spent: Spent::default(),
            number: 0,
            launched: true,
            parting: false,
            toss: Toss::still(),
            phase: Phase::none(),
            reach: None,
        }
    }

    /// Begins anew with a toss just launched. Its phase is set where contact begins.
    #[inline]
    pub(super) fn begin(&mut self, number: u64, toss: Toss) {
        (self.number, self.toss) = (number, toss);
        self.spent = Spent::default();
        (self.launched, self.parting) = (true, false);
        self.reach = None;
    }
}

pub(super) struct Pool {
    pub(super) slots: Vec<Slot>,
    pub(super) free: Vec<usize>,
    /// About to fly.
    pub(super) departing: Vec<usize>,
    /// Flying, and come down.
    pub(super) searching: Searching,
    /// Landed, and to be thrown back: that was not the last bounce.
    pub(super) again: Vec<usize>,
    /// In contact, and about to be.
    pub(super) sticks: Station,
    pub(super) slips: Station,
    pub(super) sticking: Vec<usize>,
    pub(super) slipping: Vec<usize>,
    /// Tosses at hand.
    pub(super) begin: Departing,
    pub(super) struck: StruckTosses,
}

impl Pool {
    pub(super) fn new() -> Self {
        Self {
            slots: vec![Slot::empty(); SLOTS],
            free: (0..SLOTS).rev().collect(),
            departing: Vec::with_capacity(SLOTS),
            searching: Searching::none(),
            again: Vec::with_capacity(SLOTS),
            sticks: Station::new(),
            slips: Station::new(),
            sticking: Vec::with_capacity(SLOTS),
            slipping: Vec::with_capacity(SLOTS),
            begin: Departing::default(),
            struck: StruckTosses::default(),
        }
    }

    /// Puts a toss where its next attempt at a step of contact is made.
    pub(super) fn in_contact(&mut self, slot: usize) {
        match self.slots[slot].phase.mode {
            Mode::Stick => self.sticking.push(slot),
            Mode::Slip => self.slipping.push(slot),
        }
    }
}

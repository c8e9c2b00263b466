//! The tosses that are on their way, and the stage each is at.

use super::contact::Station;
use super::struck::StruckTosses;
use crate::contact::rim::Mode;
use crate::contact::{Law, Phase, Reach, Spent};
use crate::flight::{Departing, Group};
use crate::toss::Toss;
use coinmc_lanes::Lanes;
use coinmc_lanes::{Bits, WIDTH, lanes_of};

/// Tosses on their way: enough that eight are nearly always at one stage. From 64 to 256 the speed
/// is the same within 5 %.
pub(super) const SLOTS: usize = 128;
/// Groups of flights on search: half of the tosses, the others being at other stages.
const GROUPS: usize = 8;

/// Where flights begin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Origin {
    /// With the impacts just done.
    Struck,
    Elsewhere,
}

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
    pub(super) fn new(number: u64, toss: Toss) -> Self {
        Self {
            number,
            toss,
            spent: Spent::default(),
            launched: true,
            parting: false,
            phase: Phase::none(),
            reach: None,
        }
    }
}

pub(super) struct Pool {
    pub(super) slots: Vec<Slot>,
    pub(super) free: Vec<usize>,
    /// About to fly.
    pub(super) departing: Vec<usize>,
    /// On search, and lanes that are free.
    pub(super) groups: Vec<Group>,
    pub(super) vacant: Vec<(usize, usize)>,
    /// Lanes whose search is over.
    pub(super) landed: Vec<(usize, usize)>,
    /// Landed, and to be thrown back: that was not the last bounce.
    pub(super) again: Vec<usize>,
    /// In contact, and about to be.
    pub(super) sticks: Station,
    pub(super) slips: Station,
    pub(super) sticking: Vec<usize>,
    pub(super) slipping: Vec<usize>,
    /// Tosses at hand.
    pub(super) begin: Departing,
    pub(super) fresh: Group,
    pub(super) struck: StruckTosses,
}

impl Pool {
    pub(super) fn new() -> Self {
        let lanes = (0..GROUPS).flat_map(|group| (0..WIDTH).map(move |lane| (group, lane)));
        Self {
            slots: vec![Slot::new(0, Toss::still()); SLOTS],
            free: (0..SLOTS).rev().collect(),
            departing: Vec::with_capacity(SLOTS),
            groups: vec![Group::default(); GROUPS],
            vacant: lanes.rev().collect(),
            landed: Vec::with_capacity(GROUPS * WIDTH),
            again: Vec::with_capacity(SLOTS),
            sticks: Station::new(),
            slips: Station::new(),
            sticking: Vec::with_capacity(SLOTS),
            slipping: Vec::with_capacity(SLOTS),
            begin: Departing::default(),
            fresh: Group::default(),
            struck: StruckTosses::default(),
        }
    }

    /// Puts flights of those lanes on search.
    pub(super) fn put_on_search(
        &mut self,
        kind: Lanes,
        law: &Law,
        from: Origin,
        owners: &[usize; WIDTH],
        lanes: Bits,
    ) {
        let begin = match from {
            Origin::Struck => &self.struck.after,
            Origin::Elsewhere => &self.begin,
        };
        self.fresh.depart(kind, &law.body, law.drag, begin);
        for at in lanes_of(lanes) {
            let Some((group, lane)) = self.vacant.pop() else {
                // never: whoever departs sees to the lanes first
                return;
            };
            self.groups[group].take(lane, &self.fresh, begin, at, owners[at]);
        }
    }

    /// Flights on search.
    pub(super) fn on_search(&self) -> usize {
        GROUPS * WIDTH - self.vacant.len() - self.landed.len()
    }

    /// Puts a toss where its next attempt at a step of contact is made.
    pub(super) fn in_contact(&mut self, slot: usize) {
        match self.slots[slot].phase.mode {
            Mode::Stick => self.sticking.push(slot),
            Mode::Slip => self.slipping.push(slot),
        }
    }
}

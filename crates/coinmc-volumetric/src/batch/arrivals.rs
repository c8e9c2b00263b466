//! Eight flights at the end of their search: Newton's method closes in on the first contact.

use super::columns::{ORBIT, SEARCH, START, SlotNumbers, load, start_of_flight};
use crate::body::Body;
use crate::drag::Drag;
use crate::flight::{MAX_EVALUATIONS, Orbit, Search};
use crate::motion::Motion;
use coinmc_lanes::{Bits, Block, Mask, Wide};

#[derive(Debug, Clone, Default)]
#[repr(C, align(64))]
pub(super) struct Arrivals {
    pub(super) orbit: [Block; ORBIT],
    pub(super) search: [Block; SEARCH],
    pub(super) bracket: [Block; 2],
    /// The motion with which the flight began.
    pub(super) start: [Block; START],
    pub(super) slots: SlotNumbers,
    pub(super) bracketed: Bits,
    pub(super) gave_up: Bits,
}

impl Arrivals {
    /// Ends every search. Returns the times of contact, and where the search was given up.
    #[inline(always)]
    pub(super) fn close_in<L: Wide>(&self, orbit: &Orbit<L>, body: &Body) -> (L, L::Mask) {
        let [low, high] = load::<L, 2>(&self.bracket);
        let [time, _, mut evaluations] = load::<L, SEARCH>(&self.search);
        let bracketed = L::mask(self.bracketed);
        let mut search = Search {
            time,
            low,
            high,
            bracketed,
            active: bracketed,
            least: L::splat(0.0),
            departs: L::Mask::splat(false),
            launched: L::Mask::splat(false),
        };
        let most = L::splat(f64::from(MAX_EVALUATIONS));
        let mut gave_up = L::mask(self.gave_up);
        while search.active.any() {
            let gap = orbit.gap(body, search.time);
            search.stop_at_contact(&gap);
            search.close_in(orbit, &gap);
            evaluations += L::splat(1.0);
            let over_limit = search.active & most.le(evaluations);
            gave_up = gave_up | over_limit;
            search.active = search.active & !over_limit;
        }
        (search.time, gave_up)
    }

    /// The motion with which the flight in a lane began.
    pub(super) fn start_of(&self, lane: usize) -> Motion<f64> {
        let [motion @ .., _] = &self.start;
        Motion::from_columns(&motion.map(|block| block[lane]))
    }

    /// The motions with which the flights began, and their axial angular velocities.
    #[inline(always)]
    pub(super) fn start<L: Wide>(&self) -> (Motion<L>, L) {
        start_of_flight(&load::<L, START>(&self.start))
    }

    /// The flights.
    #[inline(always)]
    pub(super) fn orbit<L: Wide>(&self, drag: Drag) -> Orbit<L> {
        Orbit::resumed(&load::<L, ORBIT>(&self.orbit), drag)
    }
}

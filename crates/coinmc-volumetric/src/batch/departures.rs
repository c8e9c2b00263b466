//! Eight flights that are about to begin.

use super::columns::{START, SlotNumbers, load, put_start, start_of_flight};
use crate::flight::Departure;
use crate::motion::{Motion, Spin};
use coinmc_lanes::{Bits, Block, Wide};

#[derive(Debug, Clone, Default)]
#[repr(C, align(64))]
pub(super) struct Departures {
    /// Motions and axial angular velocities at the start.
    pub(super) start: [Block; START],
    pub(super) slots: SlotNumbers,
    /// Lanes that depart as [`Departure::Launched`] and as [`Departure::LiftOff`].
    pub(super) launched: Bits,
    pub(super) lifts_off: Bits,
}

impl Departures {
    /// Fills one lane, except for the kind of departure.
    #[inline]
    pub(super) fn put(&mut self, lane: usize, slot: usize, motion: &Motion<f64>, spin: &Spin<f64>) {
        put_start(&mut self.start, lane, motion, spin);
        self.slots.set(lane, slot);
    }

    /// Sets the kind of departure of a lane.
    #[inline]
    pub(super) fn set_kind(&mut self, lane: usize, departure: Departure) {
        self.launched |= Bits::from(departure == Departure::Launched) << lane;
        self.lifts_off |= Bits::from(departure == Departure::LiftOff) << lane;
    }

    /// The motions and their axial angular velocities.
    #[inline(always)]
    pub(super) fn load<L: Wide>(&self) -> (Motion<L>, L) {
        start_of_flight(&load::<L, START>(&self.start))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each lane keeps its own kind of departure, in whatever order they are set.
    #[test]
    fn lanes_keep_their_kinds_of_departure() {
        let mut departures = Departures::default();
        for (lane, departure) in [
            (6, Departure::Launched),
            (1, Departure::LiftOff),
            (3, Departure::Rebound),
            (2, Departure::Launched),
            (7, Departure::LiftOff),
        ] {
            departures.set_kind(lane, departure);
        }
        assert_eq!(
            (departures.launched, departures.lifts_off),
            (0b0100_0100, 0b1000_0010)
        );
    }
}

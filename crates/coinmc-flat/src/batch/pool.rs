//! The memory of a batch: a slot for each toss, and the queues.

use crate::contact::SlidingContact;
use crate::counters::Counters;
use crate::motion::Motion;
use coinmc_core::{Ended, Outcome};
use coinmc_lanes::WIDTH;

/// A lane of a flight stage.
#[derive(Debug, Clone, Copy)]
pub(super) struct LaneId {
    pub(super) stage: usize,
    pub(super) lane: usize,
}

/// The memory of one toss, except for its motion.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Slot {
    /// Its number among the launches.
    number: u64,
    pub(super) counters: Counters,
}

/// A toss in sliding contact. Its lane of the flight stage stays reserved for it.
pub(super) struct SlidingToss {
    pub(super) id: LaneId,
    pub(super) motion: Motion,
    pub(super) contact: SlidingContact,
}

/// All slots and queues.
pub(super) struct Pool {
    slots: Vec<[Slot; WIDTH]>,
    /// Lanes without a toss.
    free: Vec<LaneId>,
    /// Tosses that slide.
    pub(super) sliding: Vec<SlidingToss>,
    /// Tosses that have ended and are not yet reported, by number.
    pub(super) ended: Vec<(u64, Outcome)>,
    launched: u64,
}

impl Pool {
    /// Room for eight tosses per stage.
    pub(super) fn new(stages: usize) -> Self {
        let lanes =
            (0..stages).flat_map(|stage| (0..WIDTH).map(move |lane| LaneId { stage, lane }));
        Self {
            slots: vec![[Slot::default(); WIDTH]; stages],
            free: lanes.rev().collect(),
            sliding: Vec::with_capacity(stages * WIDTH),
            ended: Vec::with_capacity(2 * stages * WIDTH),
            launched: 0,
        }
    }

    pub(super) fn has_room(&self) -> bool {
        !self.free.is_empty() && self.ended.len() < self.slots.len() * WIDTH
    }

    /// Numbers one more launch.
    pub(super) fn next_number(&mut self) -> u64 {
        let number = self.launched;
        self.launched += 1;
        number
    }

    /// Gives a free lane to the toss with this number. There is one, since callers launch only if
    /// there [is room](Self::has_room).
    pub(super) fn occupy(&mut self, number: u64) -> Option<LaneId> {
        let id = self.free.pop()?;
        *self.slot_mut(id) = Slot {
            number,
            ..Slot::default()
        };
        Some(id)
    }

    pub(super) fn slot_mut(&mut self, id: LaneId) -> &mut Slot {
        &mut self.slots[id.stage][id.lane]
    }

    /// Ends a toss and frees its lane.
    pub(super) fn end(&mut self, id: LaneId, ended: Ended) {
        let Slot { number, counters } = *self.slot_mut(id);
        self.ended.push((number, counters.outcome(ended)));
        self.free.push(id);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_core::Face;

    /// There is room as long as a lane is free, and until as many tosses wait to be reported as there are lanes.
    #[test]
    fn there_is_room_until_lanes_or_reports_are_used_up() {
        let mut pool = Pool::new(2);
        for number in 0..2 * WIDTH as u64 {
            assert!(pool.has_room());
            assert!(pool.occupy(number).is_some());
        }
        assert!(!pool.has_room() && pool.occupy(99).is_none());
        let mut pool = Pool::new(2);
        for _ in 0..2 * WIDTH {
            assert!(pool.has_room());
            let id = pool.occupy(0).expect("there is room");
            pool.end(id, Ended::Decided(Face::Heads));
        }
        assert!(!pool.has_room());
    }
}

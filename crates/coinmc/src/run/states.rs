//! The states of all points: of those in progress all that is needed to go on, of the others what their
//! rows are made of.

use super::packed::{Counted, Packed};
use super::point_state::PointState;
use std::collections::BTreeSet;

/// The states of all points.
#[derive(Debug)]
pub(super) struct States {
    slots: Vec<Slot>,
    /// A point of which no toss was made.
    fresh: PointState,
    /// Points in progress by the bits of their widest arm, which order like the numbers.
    arms: BTreeSet<(u64, usize)>,
    /// The widest arm of any point that has ended.
    widest_ended: Option<f64>,
}

#[derive(Debug)]
enum Slot {
    New,
    Open(Box<PointState>),
    Ended(Packed),
}

impl States {
    pub(super) fn new(points: usize, fresh: PointState) -> Self {
        Self {
            slots: (0..points).map(|_| Slot::New).collect(),
            fresh,
            arms: BTreeSet::new(),
            widest_ended: None,
        }
    }

    pub(super) fn len(&self) -> usize {
        self.slots.len()
    }

    /// The state of a point that has not ended.
    ///
    /// # Panics
    /// If it has.
    pub(super) fn open(&mut self, point: usize) -> &mut PointState {
        let slot = &mut self.slots[point];
        if matches!(slot, Slot::New) {
            *slot = Slot::Open(Box::new(self.fresh.clone()));
        }
        match slot {
            Slot::Open(state) => state,
            _ => panic!("point {point} has ended"),
        }
    }

    /// The same, of a point that was opened.
    pub(super) fn opened(&self, point: usize) -> &PointState {
        match &self.slots[point] {
            Slot::Open(state) => state,
            _ => panic!("point {point} is not in progress"),
        }
    }

    /// Ends a point.
    pub(super) fn end(&mut self, point: usize) {
        let state = self.open(point);
        let (packed, arm) = (Packed::from(&state.counted()), state.half_width);
        if state.is_seen {
            self.arms.remove(&(arm.to_bits(), point));
            self.widest_ended = Some(self.widest_ended.map_or(arm, |widest| widest.max(arm)));
        }
        self.slots[point] = Slot::Ended(packed);
    }

    /// Records the widest arm of a point in progress.
    pub(super) fn set_arm(&mut self, point: usize, arm: f64) {
        let state = self.open(point);
        let before = std::mem::replace(&mut state.half_width, arm);
        if std::mem::replace(&mut state.is_seen, true) {
            self.arms.remove(&(before.to_bits(), point));
        }
        self.arms.insert((arm.to_bits(), point));
    }

    /// The widest arm of any point; `None` before the first toss.
    pub(super) fn widest(&self) -> Option<f64> {
        let open = self.arms.last().map(|(bits, _)| f64::from_bits(*bits));
        match (open, self.widest_ended) {
            (Some(open), Some(ended)) => Some(open.max(ended)),
            (open, ended) => open.or(ended),
        }
    }

    /// What the row of a point is made of.
    pub(super) fn counted(&self, point: usize) -> Counted {
        match &self.slots[point] {
            Slot::New => self.fresh.counted(),
            Slot::Open(state) => state.counted(),
            Slot::Ended(packed) => Counted::from(packed),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::StoppedBy;

    fn states() -> States {
        States::new(2, PointState::new(None, StoppedBy::Tosses))
    }

    #[test]
    fn the_widest_arm_is_that_of_any_point() {
        let mut states = states();
        assert_eq!(states.widest(), None);
        for (point, arm, widest) in [(0, 0.3, 0.3), (1, 0.2, 0.3), (0, 0.1, 0.2)] {
            states.set_arm(point, arm);
            assert_eq!(states.widest(), Some(widest));
        }
        states.end(1);
        assert_eq!(states.widest(), Some(0.2));
        states.end(0);
        assert_eq!(states.widest(), Some(0.2));
    }

    #[test]
    #[should_panic(expected = "point 1 has ended")]
    fn a_point_that_has_ended_is_not_opened_again() {
        let mut states = states();
        states.open(1).stopped_by = StoppedBy::Tosses;
        states.end(1);
        assert_eq!(states.counted(1).stopped_by, StoppedBy::Tosses);
        states.open(1);
    }
}

//! What whoever watches a toss is shown: events, and the coin at the instants asked for between
//! them. For an observer that is not active nothing of it is compiled.

use crate::motion::{Motion, Units};
use crate::shape::Shape;
use coinmc_core::{Event, EventKind, Observer, sample_between};

/// An observer, and what it takes to show it a motion.
pub(crate) struct ObserverAdapter<'a, O> {
    pub(crate) observer: &'a mut O,
    pub(crate) units: &'a Units,
    pub(crate) shape: &'a Shape,
}

impl<O: Observer> ObserverAdapter<'_, O> {
    pub(crate) fn event(&mut self, kind: EventKind, motion: &Motion) {
        if O::ACTIVE {
            let state = motion.state(self.units, self.shape);
            self.observer.event(&Event { kind, state });
        }
    }

    /// The coin moved on from time `from` to `until`; `at` gives its motion any time after `from`.
    pub(crate) fn passed(&mut self, from: f64, until: f64, at: impl Fn(f64) -> Motion) {
        let Self { units, shape, .. } = *self;
        sample_between(
            self.observer,
            from * units.time_s,
            until * units.time_s,
            |time_s| {
                // the two roundings of the unit may lead just beyond
                let after = (time_s / units.time_s - from).clamp(0.0, until - from);
                let mut state = at(after).state(units, shape);
                state.time_s = time_s;
                state
            },
        );
    }
}

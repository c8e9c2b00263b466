//! What whoever watches a toss is shown of sustained contact: modes, and the coin at the instants
//! asked for within a step. For an observer that is not active nothing of it is compiled.

use crate::body::Units;
use crate::motion::{Motion, Spin};
use crate::toss::Place;
use coinmc_core::{Event, EventKind, Observer, sample_between};

/// An observer, and what it takes to show it a motion in contact.
pub(crate) struct Watch<'a, O> {
    pub(crate) observer: &'a mut O,
    pub(crate) place: &'a mut Place,
    pub(crate) heads_up: bool,
    pub(crate) units: &'a Units,
}

impl<O: Observer> Watch<'_, O> {
    pub(crate) fn event(&mut self, kind: EventKind, motion: &Motion<f64>, spin: &Spin<f64>) {
        if O::ACTIVE {
            let state = self.place.state(motion, spin, self.heads_up, self.units);
            self.observer.event(&Event { kind, state });
        }
    }

    /// The coin moved on for a time of `length`; `at` gives its motion any time into that.
    pub(crate) fn passed(&mut self, length: f64, at: impl Fn(f64) -> (Motion<f64>, Spin<f64>)) {
        if !O::ACTIVE {
            return;
        }
        let (start, units, heads_up) = (*self.place, *self.units, self.heads_up);
        self.place.follow(length, &at);
        sample_between(
            self.observer,
            start.time * units.time_s,
            self.place.time * units.time_s,
            |time_s| {
                // the two roundings of the unit may lead just beyond
                let after = (time_s / units.time_s - start.time).clamp(0.0, length);
                let mut place = start;
                place.follow(after, &at);
                let (motion, spin) = at(after);
                let mut state = place.state(&motion, &spin, heads_up, &units);
                state.time_s = time_s;
                state
            },
        );
    }
}

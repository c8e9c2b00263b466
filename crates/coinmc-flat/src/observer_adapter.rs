//! Shows a toss to an observer: its events, and the state of the coin at the requested instants
//! between them. For an inactive observer all of this compiles to nothing.

use crate::motion::{Motion, Units};
use crate::shape::Shape;
use coinmc_core::{Event, EventKind, Observer, sample_between};

/// An observer, with the units and the shape that turn a [`Motion`] into a state in SI units.
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

    /// The coin has moved from time `from` to `until`; `at` gives its motion a time after `from`.
    pub(crate) fn passed(&mut self, from: f64, until: f64, at: impl Fn(f64) -> Motion) {
        let Self { units, shape, .. } = *self;
        sample_between(
            self.observer,
            from * units.time_s,
            until * units.time_s,
            |time_s| {
                // the two roundings of the unit may lead just outside the interval
                let after = (time_s / units.time_s - from).clamp(0.0, until - from);
                let mut state = at(after).state(units, shape);
                state.time_s = time_s;
                state
            },
        );
    }
}

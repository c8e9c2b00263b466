//! What whoever watches a toss is shown of sustained contact: modes, and the coin at the instants
//! asked for within a step. For an observer that is not active nothing of it is compiled.

use crate::body::Units;
use crate::motion::{Motion, Spin};
use crate::toss::Place;
use coinmc_core::{Event, EventKind, Observer, sample_between};

/// An observer, and what it takes to show it a motion in contact.
pub(crate) struct ObserverAdapter<'a, O> {
    pub(crate) observer: &'a mut O,
    pub(crate) place: &'a mut Place,
    pub(crate) heads_up: bool,
    pub(crate) units: &'a Units,
}

impl<O: Observer> ObserverAdapter<'_, O> {
    pub(crate) fn event(&mut self, kind: EventKind, motion: &Motion<f64>, spin: &Spin<f64>) {
        if O::ACTIVE {
            let state = self.place.state(motion, spin, self.heads_up, self.units);
            self.observer.event(&Event { kind, state });
        }
    }

    /// The coin moved on for a time of `length`; `at` gives its motion any time into that.
    pub(crate) fn passed(&mut self, length: f64, at: impl Fn(f64) -> (Motion<f64>, Spin<f64>)) {
        // where the mode changes at once the rates of the one that is left may be no numbers (a jam, a
        // slip of 0), and no time times these neither
        if !O::ACTIVE || length == 0.0 {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::toss::Toss;
    use coinmc_core::{Coin, Scene, Surface};

    struct Nobody;

    impl Observer for Nobody {
        fn event(&mut self, _: &Event) {}
    }

    /// Of 1e6 tosses at high friction six were shown at places that were no numbers.
    #[test]
    fn a_change_of_mode_at_once_is_not_looked_into() {
        let coin = Coin::cylinder(1.0, 0.01).expect("a good coin");
        let surface = Surface::new(0.5, 9.0).expect("a good surface");
        let scene = Scene::new(coin, surface, 9.81).expect("good gravity");
        let (units, mut toss, mut nobody) = (Units::new(&scene), Toss::still(), Nobody);
        let (_, _, mut adapter) = toss.watched(&units, &mut nobody);
        adapter.passed(0.0, |_| {
            panic!("rates that may be no numbers were asked for")
        });
    }
}

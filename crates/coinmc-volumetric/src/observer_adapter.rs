//! Shows sustained contact to an observer: its modes, and the coin at the requested instants within
//! a step. For an inactive observer all of this compiles to nothing.

use crate::body::Units;
use crate::motion::{Motion, Spin};
use crate::place::Place;
use coinmc_core::{Event, EventKind, Observer, sample_between};

/// An observer, with everything needed to show it a motion in contact.
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

    /// Shows a step of `length`; `at` returns the motion at any time within the step.
    pub(crate) fn step(&mut self, length: f64, at: impl Fn(f64) -> (Motion<f64>, Spin<f64>)) {
        // A mode that ends at once may have rates that are NaN (a jam, a slip of 0), and so may
        // then be any motion computed from them, even after no time.
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
                // converting to seconds and back may round to just outside the step
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
    use coinmc_core::{Coin, Scene, State, Surface};

    struct NullObserver;

    impl Observer for NullObserver {
        fn event(&mut self, _: &Event) {}
    }

    /// Regression: at high friction, 6 of 1e6 tosses were shown at NaN positions.
    #[test]
    fn a_step_without_duration_is_not_sampled() {
        let coin = Coin::cylinder(1.0, 0.01).expect("a valid coin");
        let surface = Surface::new(0.5, 9.0).expect("a valid surface");
        let scene = Scene::new(coin, surface, 9.81).expect("valid gravity");
        let mut adapter = ObserverAdapter {
            observer: &mut NullObserver,
            place: &mut Place::origin([1.0, 0.0]),
            heads_up: true,
            units: &Units::new(&scene),
        };
        adapter.step(0.0, |_| panic!("rates that may be NaN were asked for"));
    }

    /// Looks at the coin at three instants.
    struct Looks(Vec<State>);

    impl Observer for Looks {
        fn event(&mut self, _: &Event) {}

        fn wants_at_s(&self) -> f64 {
            const WANTED_S: [f64; 3] = [0.5, 0.504, 0.51];
            WANTED_S.get(self.0.len()).copied().unwrap_or(f64::INFINITY)
        }

        fn sample(&mut self, state: &State) {
            self.0.push(*state);
        }
    }

    /// A step that begins late in a toss is shown at the instants that are asked for, with the motion that it has then, gone as far as
    /// its velocity has taken it.
    #[test]
    fn a_step_is_shown_at_the_instants_that_are_asked_for() {
        let coin = Coin::cylinder(1.0, 0.01).expect("a valid coin");
        let surface = Surface::new(0.5, 0.3).expect("a valid surface");
        let scene = Scene::new(coin, surface, 9.81).expect("valid gravity");
        let units = Units::new(&scene);
        let (mut looks, mut place) = (Looks(Vec::new()), Place::origin([1.0, 0.0]));
        place.time = 0.499 / units.time_s;
        let mut adapter = ObserverAdapter {
            observer: &mut looks,
            place: &mut place,
            heads_up: true,
            units: &units,
        };
        let at = |t: f64| {
            let motion = Motion {
                sin: 1.0,
                vx: 0.2 + t,
                vz: 3.0 * t,
                z: 1.0,
                ..Motion::still()
            };
            (motion, Spin::still())
        };
        let length = 0.02 / units.time_s;
        adapter.step(length, at);
        assert_eq!(looks.0.len(), 3);
        for (state, time_s) in looks.0.iter().zip([0.5, 0.504, 0.51]) {
            let t = (time_s - 0.499) / units.time_s;
            let (rises, way) = (3.0 * t, 0.2 * t + 0.5 * t * t);
            assert_eq!(state.time_s, time_s);
            assert!((state.velocity_m_s.z / units.speed_m_s() - rises).abs() < 1e-9);
            assert!((state.position_m.x / units.length_m - way).abs() < 1e-9);
        }
        assert!((place.time * units.time_s - 0.519).abs() < 1e-12);
    }
}

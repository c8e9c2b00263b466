//! What an observer is shown, and that looking changes nothing.

use crate::common::{Tosser, quick};
use coinmc_core::{Engine, Event, EventKind, Observer, Preset, State};
use coinmc_rapier::{Flight, RapierEngine, Settings};
use coinmc_testkit::{preset_launch, scene, table1};

/// Keeps everything, and samples at a rate.
#[derive(Default)]
struct Film {
    rate_hz: f64,
    wanted: u32,
    last: Option<State>,
    events: Vec<EventKind>,
    furthest_m: f64,
}

impl Film {
    fn see(&mut self, state: &State) {
        if let Some(last) = self.last {
            assert!(last.time_s <= state.time_s);
            let moved = (state.position_m - last.position_m).norm();
            self.furthest_m = self.furthest_m.max(moved);
        }
        assert!((state.axis.norm() - 1.0).abs() < 1e-9);
        self.last = Some(*state);
    }
}

impl Observer for Film {
    fn event(&mut self, event: &Event) {
        self.events.push(event.kind);
        self.see(&event.state);
    }

    fn wants_at_s(&self) -> f64 {
        f64::from(self.wanted) / self.rate_hz
    }

    fn sample(&mut self, state: &State) {
        assert_eq!(state.time_s, self.wants_at_s());
        self.wanted += 1;
        self.see(state);
    }
}

/// The account is the same, events are in order, and nothing jumps: at 100 samples a second a coin
/// of this scene moves by less than 0.3 m between two of them, offset or not.
#[test]
fn a_watched_toss_is_the_same_toss() {
    let coarse = Settings {
        step_s: 0.02,
        ..Settings::default()
    };
    let steps = Settings {
        flight: Flight::Steps,
        ..quick()
    };
    for (scene, preset, settings) in [
        (scene(1.0, 0.5, 0.3), Preset::Clean, quick()),
        (scene(0.5, 0.0, 0.3), Preset::Clean, steps),
        (table1(1.0), Preset::Table1, coarse),
    ] {
        let engine = RapierEngine::new(&scene, &settings).unwrap();
        let mut blind = Tosser::new(&scene, &settings);
        let mut workspace = engine.workspace();
        for toss in 0..60 {
            let launch = preset_launch(preset, &scene, 60, toss);
            let mut film = Film {
                rate_hz: 100.0,
                ..Film::default()
            };
            let outcome = engine.toss(&mut workspace, &launch, &mut film);
            assert_eq!(outcome, blind.toss(&launch), "{toss}");
            assert_eq!(film.events.first(), Some(&EventKind::Launched));
            assert_eq!(film.events.last(), Some(&EventKind::Ended));
            let count = |kind| film.events.iter().filter(|k| **k == kind).count();
            assert_eq!(count(EventKind::Touching), outcome.impacts as usize);
            assert_eq!(count(EventKind::Impact), outcome.impacts as usize);
            assert!(
                film.wanted > 10 && film.furthest_m < 0.3,
                "{}",
                film.furthest_m
            );
        }
    }
}

/// An observer that never moves on does not hold up the toss.
#[test]
fn an_observer_that_stands_still_is_passed_over() {
    struct Stuck;
    impl Observer for Stuck {
        fn event(&mut self, _: &Event) {}

        fn wants_at_s(&self) -> f64 {
            0.1
        }
    }
    let scene = scene(1.0, 0.5, 0.3);
    let engine = RapierEngine::new(&scene, &quick()).unwrap();
    let launch = preset_launch(Preset::Clean, &scene, 61, 0);
    let outcome = engine.toss(&mut engine.workspace(), &launch, &mut Stuck);
    assert_eq!(outcome, Tosser::new(&scene, &quick()).toss(&launch));
}

//! For tests: an engine that is as simple as can be, its launches, and an observer that notes what it sees.

use crate::{
    Coin, Domain, Ended, Engine, Event, EventKind, Face, Launch, LaunchDistribution, Observer,
    Outcome, Preset, Scene, State, Stream, Surface, sample_between,
};
use nalgebra::Vector3;
use std::ops::ControlFlow;

/// A coin that falls from rest, does not turn, and lies as it lands. Under g = 10 m/s² it is at
/// h - 5t² after t.
#[derive(Debug, Clone)]
pub(crate) struct Fall;

impl Engine for Fall {
    type Workspace = ();

    fn workspace(&self) {}

    fn toss(&self, (): &mut (), launch: &Launch, observer: &mut impl Observer) -> Outcome {
        let state = |time_s: f64| State {
            time_s,
            position_m: Vector3::new(0.0, 0.0, launch.height_m - 5.0 * time_s * time_s),
            velocity_m_s: Vector3::new(0.0, 0.0, -10.0 * time_s),
            axis: launch.axis,
            spin_rad_s: Vector3::zeros(),
        };
        let event = |kind, time_s| Event {
            kind,
            state: state(time_s),
        };
        let lands_s = (launch.height_m / 5.0).sqrt();
        observer.event(&event(EventKind::Launched, 0.0));
        sample_between(observer, 0.0, lands_s, state);
        let decided = Outcome::decided(launch.up().unwrap_or(Face::Side));
        if observer.has_seen_enough() {
            let ended = Ended::TimeLimit;
            return Outcome { ended, ..decided };
        }
        observer.event(&event(EventKind::Ended, lands_s));
        decided
    }
}

/// A coin on a table under g = 10 m/s².
pub(crate) fn scene() -> Scene {
    let coin = Coin::cylinder(0.5, 0.01).unwrap();
    Scene::new(coin, Surface::new(0.5, 0.3).unwrap(), 10.0).unwrap()
}

/// From rest at 1 m, with any face up.
pub(crate) fn distribution() -> LaunchDistribution {
    Preset::Drop.distribution()
}

/// The random numbers of these launches.
pub(crate) fn stream() -> Stream {
    Stream::new(7, Domain::Launch, 0)
}

/// The first of these launches.
pub(crate) fn launches(tosses: u64) -> Vec<Launch> {
    let (coin, stream) = (scene().coin, stream());
    (0..tosses)
        .map(|toss| distribution().launch(&coin, &mut stream.toss(toss)))
        .collect()
}

/// The outcomes of these launches, each tossed alone, with their numbers.
pub(crate) fn outcomes_alone(launches: &[Launch]) -> Vec<(u64, Outcome)> {
    let toss = |launch| Fall.toss(&mut (), launch, &mut ());
    (0..).zip(launches.iter().map(toss)).collect()
}

/// What is passed on to a sink that breaks at this call.
pub(crate) fn passed_on<T: Clone>(
    breaks_at: usize,
    toss: impl FnOnce(&mut dyn FnMut(&[T]) -> ControlFlow<()>),
) -> Vec<Vec<T>> {
    let mut calls = Vec::new();
    toss(&mut |ended| {
        calls.push(ended.to_vec());
        if calls.len() == breaks_at {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    });
    calls
}

/// Notes all events, and the coin at every tenth of a second.
#[derive(Debug, PartialEq)]
pub(crate) struct Notes {
    /// The samples that suffice.
    pub(crate) enough: usize,
    /// Events seen.
    pub(crate) events: Vec<Event>,
    /// The coin at 0, 0.1, 0.2 s and so on.
    pub(crate) samples: Vec<State>,
}

impl Notes {
    /// Nothing yet; after `enough` samples the rest does not matter.
    pub(crate) fn new(enough: usize) -> Self {
        Self {
            enough,
            events: Vec::new(),
            samples: Vec::new(),
        }
    }
}

impl Observer for Notes {
    fn event(&mut self, event: &Event) {
        self.events.push(*event);
    }

    fn wants_at_s(&self) -> f64 {
        0.1 * self.samples.len() as f64
    }

    fn sample(&mut self, state: &State) {
        // a fall from 1 m has five; one that goes on for ever must not fill the memory
        assert!(self.samples.len() < 100, "sampled beyond the end");
        self.samples.push(*state);
    }

    fn has_seen_enough(&self) -> bool {
        self.samples.len() >= self.enough
    }
}

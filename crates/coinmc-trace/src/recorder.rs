//! An observer that records a toss.

use crate::record::{Mode, Record, RecordKind};
use crate::turning::Turning;
use coinmc_core::{Event, EventKind, Observer, Scene, State};

/// Default limit of records per trace, about 30 MB.
pub const MAX_RECORDS: usize = 200_000;

/// Records a toss: every event, and the coin at a fixed rate between them.
///
/// Memory is bounded. Once half of the records are used, no more samples are taken, which leaves
/// room for the events of a long toss; once all are used, only the end is still recorded. The trace
/// says from when on.
///
/// # Example
/// ```
/// use coinmc_trace::Recorder;
/// use coinmc_core::{Coin, Domain, Engine, Preset, Scene, Stream, Surface};
/// use coinmc_flat::{FlatEngine, Moreau, Settings};
/// let coin = Coin::cylinder(1.5, 0.01)?;
/// let scene = Scene::new(coin, Surface::new(0.5, 0.3)?, 9.81)?;
/// let engine = FlatEngine::new(&scene, &Settings::default(), Moreau)?;
/// let launch = Preset::Robot
///     .distribution()
///     .launch(&coin, &mut Stream::new(1, Domain::Launch, 0).toss(0));
/// let mut recorder = Recorder::new(&scene, 100.0, 10_000);
/// engine.toss(&mut (), &launch, &mut recorder);
/// let records = recorder.into_records();
/// assert_eq!(records[0].kind.name(), "launched");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Recorder {
    scene: Scene,
    rate_hz: f64,
    max_records: usize,
    records: Vec<Record>,
    mode: Mode,
    turning: Turning,
    /// Number of samples so far.
    samples: u64,
    samples_until_s: Option<f64>,
    events_until_s: Option<f64>,
}

impl Recorder {
    /// A recorder for a toss in this scene: `rate_hz` samples per second (0 for events only), at
    /// most
    /// `max_records` records and the end.
    pub fn new(scene: &Scene, rate_hz: f64, max_records: usize) -> Self {
        Self {
            scene: *scene,
            rate_hz,
            max_records,
            records: Vec::new(),
            mode: Mode::Flight,
            turning: Turning::new(scene),
            samples: 0,
            samples_until_s: None,
            events_until_s: None,
        }
    }

    /// Time of the last recorded sample, s, if the recorder was full before the end.
    pub fn samples_until_s(&self) -> Option<f64> {
        self.samples_until_s
    }

    /// The same for events.
    pub fn events_until_s(&self) -> Option<f64> {
        self.events_until_s
    }

    /// The records, in order of time.
    pub fn into_records(self) -> Vec<Record> {
        self.records
    }

    fn push(&mut self, kind: RecordKind, before: Mode, state: &State) {
        let orientation = self.turning.turn(state, before);
        self.records.push(Record {
            kind,
            mode: self.mode,
            state: *state,
            orientation,
            energy_j_kg: state.energy_j_kg(&self.scene),
        });
    }

    /// Corrects the mode of an impact that is followed by sustained contact at the same instant.
    fn correct_impact_mode(&mut self, mode: Mode, time_s: f64) {
        let now = self.records.iter_mut().rev();
        for record in now.take_while(|record| record.state.time_s == time_s) {
            if matches!(record.kind, RecordKind::Event(EventKind::Impact)) {
                record.mode = mode;
                break;
            }
        }
    }
}

impl Observer for Recorder {
    fn event(&mut self, event: &Event) {
        let before = self.mode;
        self.mode = match event.kind {
            EventKind::Launched | EventKind::Impact | EventKind::LiftOff => Mode::Flight,
            EventKind::Touching => self.mode,
            EventKind::Sticking => Mode::Sticking,
            EventKind::Sliding => Mode::Sliding,
            EventKind::Ended => Mode::Ended,
        };
        if matches!(self.mode, Mode::Sticking | Mode::Sliding) {
            self.correct_impact_mode(self.mode, event.state.time_s);
        }
        let is_end = event.kind == EventKind::Ended;
        if self.events_until_s.is_none() && self.records.len() >= self.max_records {
            self.events_until_s = self.records.last().map(|last| last.state.time_s);
        }
        if self.events_until_s.is_none() || is_end {
            self.push(RecordKind::Event(event.kind), before, &event.state);
        }
    }

    fn wants_at_s(&self) -> f64 {
        if self.rate_hz > 0.0 && self.samples_until_s.is_none() {
            (self.samples + 1) as f64 / self.rate_hz
        } else {
            f64::INFINITY
        }
    }

    fn sample(&mut self, state: &State) {
        self.samples += 1;
        self.push(RecordKind::Sample, self.mode, state);
        if self.records.len() >= self.max_records / 2 {
            self.samples_until_s = Some(state.time_s);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_core::{Coin, Surface};
    use nalgebra::{UnitVector3, Vector3};

    fn recorder(max_records: usize) -> Recorder {
        let coin = Coin::cylinder(1.0, 0.01).unwrap();
        let scene = Scene::new(coin, Surface::new(0.5, 0.3).unwrap(), 9.81).unwrap();
        Recorder::new(&scene, 10.0, max_records)
    }

    fn state(time_s: f64) -> State {
        State {
            time_s,
            position_m: Vector3::zeros(),
            velocity_m_s: Vector3::zeros(),
            axis: UnitVector3::new_unchecked(Vector3::z()),
            spin_rad_s: Vector3::zeros(),
        }
    }

    fn event(kind: EventKind, time_s: f64) -> Event {
        Event {
            kind,
            state: state(time_s),
        }
    }

    #[test]
    fn samples_are_requested_at_whole_multiples() {
        let mut recorder = recorder(100);
        for n in 1..=20 {
            let wanted = recorder.wants_at_s();
            assert_eq!(wanted, f64::from(n) / 10.0);
            recorder.sample(&state(wanted));
        }
    }

    #[test]
    fn a_full_recorder_takes_only_events_then_only_the_end() {
        let mut recorder = recorder(8);
        recorder.event(&event(EventKind::Launched, 0.0));
        while recorder.wants_at_s().is_finite() {
            let wanted = recorder.wants_at_s();
            recorder.sample(&state(wanted));
        }
        assert_eq!(recorder.samples_until_s(), Some(0.3));
        for i in 1..10 {
            recorder.event(&event(EventKind::Impact, f64::from(i)));
        }
        recorder.event(&event(EventKind::Ended, 10.0));
        assert_eq!(recorder.events_until_s(), Some(4.0));
        let records = recorder.into_records();
        assert_eq!(records.len(), 9);
        assert_eq!(records[8].mode, Mode::Ended);
    }

    #[test]
    fn the_mode_is_that_after_the_record() {
        let mut recorder = recorder(100);
        for (kind, time_s) in [
            (EventKind::Launched, 0.0),
            (EventKind::Touching, 1.0),
            (EventKind::Impact, 1.0),
            (EventKind::Touching, 2.0),
            (EventKind::Impact, 2.0),
            (EventKind::Sliding, 2.0),
            (EventKind::Sticking, 3.0),
            (EventKind::LiftOff, 4.0),
            (EventKind::Ended, 5.0),
        ] {
            recorder.event(&event(kind, time_s));
        }
        let modes: Vec<_> = recorder
            .into_records()
            .iter()
            .map(|r| r.mode.name())
            .collect();
        assert_eq!(
            modes,
            [
                "flight", "flight", "flight", "flight", "sliding", "sliding", "sticking", "flight",
                "ended"
            ]
        );
    }
}

//! Observers: every event, samples at a rate or at given instants, extremes of energy and distance.

use coinmc_core::{Event, EventKind, Observer, Rim, Scene, State};

/// More events than a toss of any test has: one that never ends must not fill the memory.
const MOST: usize = 1_000_000;

/// Keeps all events of a toss.
#[derive(Default)]
pub struct Recorder(pub Vec<Event>);

impl Observer for Recorder {
    fn event(&mut self, event: &Event) {
        assert!(self.0.len() < MOST, "no end: {event:?}");
        self.0.push(*event);
    }
}

/// Keeps all events of a toss, and the coin at the multiples of a time.
pub struct Sampler {
    /// Samples per second.
    pub rate_hz: f64,
    /// Samples taken.
    pub taken: u32,
    /// All events.
    pub events: Vec<Event>,
    /// Each with the kind of the event before it.
    pub samples: Vec<Event>,
}

impl Sampler {
    /// With this rate.
    pub fn new(rate_hz: f64) -> Self {
        Self {
            rate_hz,
            taken: 0,
            events: Vec::new(),
            samples: Vec::new(),
        }
    }
}

impl Observer for Sampler {
    fn event(&mut self, event: &Event) {
        assert!(self.events.len() < MOST, "no end: {event:?}");
        self.events.push(*event);
    }

    fn wants_at_s(&self) -> f64 {
        if (self.taken as usize) < MOST {
            f64::from(self.taken) / self.rate_hz
        } else {
            f64::INFINITY
        }
    }

    fn sample(&mut self, state: &State) {
        assert_eq!(state.time_s, self.wants_at_s());
        self.taken += 1;
        let before = self.events.last().expect("a launch");
        assert!(before.state.time_s <= state.time_s);
        self.samples.push(Event {
            kind: before.kind,
            state: *state,
        });
    }
}

/// Samples the given instants.
pub struct Instants {
    wanted: std::vec::IntoIter<f64>,
    next: f64,
    /// The coin at each.
    pub seen: Vec<State>,
}

impl Instants {
    /// These, in ascending order, s.
    pub fn new(wanted: Vec<f64>) -> Self {
        let mut wanted = wanted.into_iter();
        Self {
            next: wanted.next().unwrap_or(f64::INFINITY),
            wanted,
            seen: Vec::new(),
        }
    }
}

impl Observer for Instants {
    fn event(&mut self, _: &Event) {}

    fn wants_at_s(&self) -> f64 {
        self.next
    }

    fn sample(&mut self, state: &State) {
        self.seen.push(*state);
        self.next = self.wanted.next().unwrap_or(f64::INFINITY);
    }
}

/// The coin just after each event and just before the next, `near_s` away, each with its event: of
/// all pairs of events that are ten times as far apart. `toss` makes the same toss for any
/// observer.
///
/// # Panics
/// If an instant is not sampled.
pub fn samples_beside_events(
    events: &[Event],
    near_s: f64,
    toss: impl FnOnce(&mut Instants),
) -> Vec<(Event, State)> {
    let pairs = events.windows(2).map(|pair| (pair[0], pair[1]));
    let apart = |(from, to): &(Event, Event)| to.state.time_s - from.state.time_s > 10.0 * near_s;
    let pairs: Vec<(Event, Event)> = pairs.filter(apart).collect();
    let near = |(from, to): &(Event, Event)| [from.state.time_s + near_s, to.state.time_s - near_s];
    let mut instants = Instants::new(pairs.iter().flat_map(near).collect());
    toss(&mut instants);
    assert_eq!(instants.seen.len(), 2 * pairs.len());
    let events = pairs.into_iter().flat_map(|(from, to)| [from, to]);
    events.zip(instants.seen).collect()
}

/// The largest gain of energy and the largest distance from the surface in a toss.
#[derive(Debug)]
pub struct Extremes<'a> {
    scene: &'a Scene,
    last: Option<(EventKind, f64)>,
    last_time_s: f64,
    /// Relative gain of energy between two events that do not enclose a flight.
    pub gain: f64,
    /// Relative change of energy in a flight.
    pub drift: f64,
    /// Distance of the lowest point from the surface at an event of contact, in D.
    pub gap: f64,
    /// Distance at the end of a flight, relative to what the rounding of its phase and fall
    /// explains.
    pub gap_in_roundings: f64,
}

impl<'a> Extremes<'a> {
    /// Before the first event.
    pub fn new(scene: &'a Scene) -> Self {
        Self {
            scene,
            last: None,
            last_time_s: 0.0,
            gain: f64::NEG_INFINITY,
            drift: 0.0,
            gap: 0.0,
            gap_in_roundings: 0.0,
        }
    }

    fn see_energy(&mut self, event: &Event) {
        let energy = event.state.energy_j_kg(self.scene);
        if let Some((from, before)) = self.last {
            let change = energy / before - 1.0;
            let departs = matches!(
                from,
                EventKind::Launched | EventKind::Impact | EventKind::LiftOff
            );
            if departs && event.kind == EventKind::Touching {
                self.drift = self.drift.max(change.abs());
            } else {
                self.gain = self.gain.max(change);
            }
        }
        self.last = Some((event.kind, energy));
    }

    fn see_gap(&mut self, event: &Event) {
        let (coin, state) = (&self.scene.coin, &event.state);
        let across = (state.axis.x.powi(2) + state.axis.y.powi(2)).sqrt();
        let [heads, tails] = coin.rims();
        let below = |rim: Rim, up: f64| rim.radius_m * across - rim.distance_m * up;
        let lowest = below(heads, state.axis.z).max(below(tails, -state.axis.z));
        let lowest = lowest + coin.rim_radius_m();
        let gap = (state.position_m.z - lowest).abs() / coin.rim_distance_m();
        if !matches!(event.kind, EventKind::Launched | EventKind::Ended) {
            self.gap = self.gap.max(gap);
        }
        if event.kind == EventKind::Touching {
            let time_s = state.time_s - self.last_time_s;
            let phase = state.spin_rad_s.norm() * time_s;
            let fall = self.scene.gravity_m_s2() * time_s * time_s / coin.rim_distance_m();
            let rounding = f64::EPSILON * (1.0 + phase + fall);
            self.gap_in_roundings = self.gap_in_roundings.max(gap / rounding);
        }
        self.last_time_s = state.time_s;
    }
}

impl Observer for Extremes<'_> {
    fn event(&mut self, event: &Event) {
        self.see_energy(event);
        self.see_gap(event);
    }
}

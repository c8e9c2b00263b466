//! Observations of one toss from outside the engine.

use crate::flight::Leg;
use crate::legs::Legs;
use crate::worst::largest;
use coinmc_core::{Event, EventKind, Observer, Scene, State};

/// The worst of a toss. Each is −∞ where nothing of the kind happened.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seen {
    /// Gain of energy in an impact or a contact phase, relative to the energy before.
    pub(super) gain: f64,
    /// Distance of the lowest point from the surface at a contact, in D.
    pub(super) residual: f64,
    /// Relative change of energy in flight.
    pub(super) drift: f64,
    /// Penetration in a flight that was sampled densely, in D.
    pub(super) depth: f64,
    /// Flights sampled densely.
    pub(super) flights: u64,
    /// Those that pass over a contact.
    pub(super) missed: u64,
    /// A number of an event's state is infinite or NaN.
    pub(super) not_finite: bool,
    /// Whether the batch gives the outcome of the scalar path, if it was made both ways.
    pub(super) agrees: Option<bool>,
}

impl Seen {
    /// Of a toss that is not observed.
    pub(super) fn nothing() -> Self {
        Self {
            gain: f64::NEG_INFINITY,
            residual: f64::NEG_INFINITY,
            drift: f64::NEG_INFINITY,
            depth: f64::NEG_INFINITY,
            flights: 0,
            missed: 0,
            not_finite: false,
            agrees: None,
        }
    }
}

/// Observes one toss.
pub(super) struct Witness<'a> {
    scene: &'a Scene,
    samples_flights: bool,
    legs: Legs,
    last: Option<(EventKind, f64)>,
    pub(super) seen: Seen,
}

impl<'a> Witness<'a> {
    pub(super) fn new(scene: &'a Scene, samples_flights: bool) -> Self {
        Self {
            scene,
            samples_flights,
            legs: Legs::default(),
            last: None,
            seen: Seen::nothing(),
        }
    }

    /// Height of the lowest point, in D.
    fn gap(&self, state: &State) -> f64 {
        let (coin, u) = (&self.scene.coin, &state.axis);
        // from the horizontal part: 1 − u_z² has no digits left near 0
        let across = (u.x * u.x + u.y * u.y).sqrt();
        let lowest = 0.5 * coin.height_m() * u.z.abs() + coin.radius_m() * across;
        (state.position_m.z - lowest) / coin.rim_distance_m()
    }

    fn fly(&mut self, start: &State, end: &State) {
        let energies = [start, end].map(|state| state.energy_j_kg(self.scene));
        let drift = (energies[1] / energies[0] - 1.0).abs();
        self.seen.drift = largest(self.seen.drift, drift);
        if self.samples_flights {
            let depth = Leg::new(self.scene, start, end).depth();
            self.seen.flights += 1;
            self.seen.missed += u64::from(Leg::is_missed(depth));
            self.seen.depth = largest(self.seen.depth, depth);
        }
    }
}

impl Observer for Witness<'_> {
    fn event(&mut self, event: &Event) {
        let energy = event.state.energy_j_kg(self.scene);
        self.seen.not_finite |= !energy.is_finite() || !event.state.axis.x.is_finite();
        if let Some((from, before)) = self.last {
            let gains = matches!(
                (from, event.kind),
                (EventKind::Touching, EventKind::Impact)
                    | (EventKind::Sticking | EventKind::Sliding, _)
            );
            if gains {
                self.seen.gain = largest(self.seen.gain, energy / before - 1.0);
            }
        }
        let touches = matches!(
            event.kind,
            EventKind::Touching | EventKind::Impact | EventKind::LiftOff
        );
        if touches {
            let gap = self.gap(&event.state).abs();
            self.seen.residual = largest(self.seen.residual, gap);
        }
        // two impacts at one instant, at one rim and then the other, enclose no flight
        let flown = |(start, end): &(State, State)| start.time_s < end.time_s;
        if let Some((start, end)) = self.legs.see(event).filter(flown) {
            self.fly(&start, &end);
        }
        self.last = Some((event.kind, energy));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_bench::Case;
    use coinmc_core::Preset;
    use nalgebra::Vector3;

    fn event(kind: EventKind, time_s: f64, height_m: f64, speed: f64) -> Event {
        let state = State {
            time_s,
            position_m: Vector3::new(0.0, 0.0, height_m),
            velocity_m_s: Vector3::new(0.0, 0.0, speed),
            axis: Vector3::z_axis(),
            spin_rad_s: Vector3::zeros(),
        };
        Event { kind, state }
    }

    /// H = 1 cm, let go so that its lower face is `drop` above the surface.
    fn watch(events: &[Event]) -> Seen {
        let case = Case::new(Preset::Robot, 0.01, 1.0, 0.5, 0.3);
        let mut witness = Witness::new(&case.scene, true);
        for event in events {
            witness.event(event);
        }
        witness.seen
    }

    #[test]
    fn a_fall_to_the_surface_is_clean_and_one_beyond_is_not() {
        let g = coinmc_core::Scene::STANDARD_GRAVITY_M_S2;
        let fall = |depth: f64| {
            let v = (2.0 * g * (0.1 + depth)).sqrt();
            watch(&[
                event(EventKind::Launched, 0.0, 0.105, 0.0),
                event(EventKind::Touching, v / g, 0.005 - depth, -v),
            ])
        };
        let clean = fall(0.0);
        assert_eq!((clean.flights, clean.missed), (1, 0));
        assert!(clean.residual < 1e-15 && clean.drift < 1e-14 && !clean.not_finite);
        let deep = fall(1e-6);
        assert_eq!((deep.flights, deep.missed), (1, 1));
        // D is 1.118 cm
        assert!((deep.residual - 1e-6 / 0.011_18).abs() < 1e-7);
    }

    #[test]
    fn gains_show_in_impacts_and_nan_anywhere() {
        let seen = watch(&[
            event(EventKind::Touching, 0.0, 0.005, -1.0),
            event(EventKind::Impact, 0.0, 0.005, 1.1),
        ]);
        let potential = 0.005 * coinmc_core::Scene::STANDARD_GRAVITY_M_S2;
        let expected = (0.605 + potential) / (0.5 + potential) - 1.0;
        assert!((seen.gain - expected).abs() < 1e-14, "{}", seen.gain);
        let seen = watch(&[event(EventKind::Ended, 0.0, f64::NAN, 0.0)]);
        assert!(seen.not_finite);
    }
}

//! What single motions must be.

use crate::common::{Tosser, quick};
use coinmc_core::{Engine, Event, EventKind, Launch, Observer, Preset, Scene, State, Surface};
use coinmc_rapier::{Decision, RapierEngine, Settings};
use coinmc_testkit::{preset_launch, scene, table1};
use nalgebra::{UnitVector3, Vector3};

/// Keeps states: at events, and at a rate until a time.
struct Watch {
    rate_hz: f64,
    until_s: f64,
    taken: Vec<State>,
    events: Vec<Event>,
}

impl Observer for Watch {
    fn event(&mut self, event: &Event) {
        self.events.push(*event);
    }

    fn wants_at_s(&self) -> f64 {
        let next = self.taken.len() as f64 / self.rate_hz;
        if next < self.until_s {
            next
        } else {
            f64::INFINITY
        }
    }

    fn sample(&mut self, state: &State) {
        self.taken.push(*state);
    }
}

fn watched(
    scene: &Scene,
    settings: &Settings,
    launch: &Launch,
    rate_hz: f64,
    until_s: f64,
) -> Watch {
    let engine = RapierEngine::new(scene, settings).unwrap();
    let mut watch = Watch {
        rate_hz,
        until_s,
        taken: Vec::new(),
        events: Vec::new(),
    };
    engine.toss(&mut engine.workspace(), launch, &mut watch);
    watch
}

/// Followed to rest, so that nothing is decided before it happens.
fn patient() -> Settings {
    Settings {
        decision: Decision::Rest,
        step_s: 2e-4,
        time_limit: 60.0,
        ..Settings::default()
    }
}

/// Energy and angular momentum of a free top, to rounding.
#[test]
fn flight_keeps_energy_and_angular_momentum() {
    let scene = scene(0.5, 0.5, 0.3);
    let coin = &scene.coin;
    for toss in 0..20 {
        let launch = preset_launch(Preset::Clean, &scene, 50, toss);
        // from 1 m the coin falls for 0.44 s at least
        let watch = watched(&scene, &quick(), &launch, 100.0, 0.43);
        assert_eq!(watch.taken.len(), 43);
        let momentum = |state: &State| {
            let axis = state.axis.into_inner();
            let along = axis * state.spin_rad_s.dot(&axis);
            along * coin.axial_gyration_m2()
                + (state.spin_rad_s - along) * coin.transverse_gyration_m2()
        };
        let first = &watch.taken[0];
        let energy = first.energy_j_kg(&scene);
        for state in &watch.taken {
            let off = momentum(state) - momentum(first);
            assert!(off.norm() <= 1e-12 * momentum(first).norm(), "{toss}");
            assert!((state.energy_j_kg(&scene) / energy - 1.0).abs() < 1e-12);
        }
    }
}

/// Measured: no toss of these ever rises above its energy at launch by more than 1e-9 of it; the
/// bound leaves room for what other scenes do, see docs/methods/rapier.md.
#[test]
fn energy_stays_below_its_value_at_launch() {
    for (scene, preset, settings) in [
        (scene(0.5, 0.5, 0.3), Preset::Clean, quick()),
        (scene(1.0, 0.8, 0.3), Preset::Clean, quick()),
        (
            table1(1.0),
            Preset::Table1,
            Settings {
                step_s: 0.02,
                ..Settings::default()
            },
        ),
    ] {
        let mut tosser = Tosser::new(&scene, &settings);
        for toss in 0..100 {
            let account = tosser.examine(&preset_launch(preset, &scene, 51, toss));
            assert!(account.energy_gain < 1e-3, "{toss} {account:?}");
        }
    }
}

/// One point of the rim, no spin: v_n⁺ = −e v_n⁻, but for the fall during the step.
#[test]
fn a_single_point_bounces_with_its_restitution() {
    let settings = Settings {
        step_s: 1e-5,
        ..Settings::default()
    };
    for e in [0.3, 0.5, 0.8] {
        let scene = scene(0.5, e, 0.0);
        let launch = Launch {
            height_m: 0.2,
            velocity_m_s: Vector3::zeros(),
            axis: UnitVector3::new_normalize(Vector3::new(0.5, 0.0, 0.8)),
            spin_rad_s: Vector3::zeros(),
        };
        let watch = watched(&scene, &settings, &launch, 1.0, 0.0);
        let at = |kind| {
            let event = watch
                .events
                .iter()
                .find(|event| event.kind == kind)
                .unwrap();
            let state = &event.state;
            // the lowest point: R e_θ − (H/2) u
            let axis = state.axis.into_inner();
            let lean = (axis.x * axis.x + axis.y * axis.y).sqrt();
            let down = Vector3::new(axis.x * axis.z / lean, axis.y * axis.z / lean, -lean);
            let coin = &scene.coin;
            let lever = down * coin.radius_m() - axis * (coin.height_m() / 2.0);
            (state.velocity_m_s + state.spin_rad_s.cross(&lever)).z
        };
        let measured = -at(EventKind::Impact) / at(EventKind::Touching);
        assert!((measured - e).abs() < 2e-3, "{e}: {measured}");
    }
}

/// A rolling wheel is slowed by ρ_c g/(k_a + R²), its spin about the vertical aside.
#[test]
fn contour_friction_slows_a_wheel() {
    let mut scene = scene(1.0, 0.0, 1.0);
    let (radius, rho) = (0.01, 1e-4);
    scene.surface = scene.surface.with_friction_lengths(rho, 0.0).unwrap();
    let rate = 20.0;
    let launch = Launch {
        height_m: radius,
        velocity_m_s: Vector3::new(0.0, -rate * radius, 0.0),
        axis: Vector3::x_axis(),
        spin_rad_s: Vector3::new(rate, 0.0, 0.0),
    };
    let watch = watched(&scene, &patient(), &launch, 100.0, 0.3);
    let spin = |i: usize| watch.taken[i].spin_rad_s.x;
    let slowed = (spin(5) - spin(25)) / 0.2;
    let expected = rho * 9.81 / (1.5 * radius * radius);
    assert!(
        (slowed / expected - 1.0).abs() < 0.05,
        "{slowed} {expected}"
    );
}

/// A coin on a smooth surface that spins about the vertical is slowed by ρ_p g/k_t.
#[test]
fn pivoting_friction_slows_a_spinning_coin() {
    let coin = scene(0.5, 0.0, 0.0).coin;
    let surface = Surface::new(0.0, 0.0).unwrap();
    let surface = surface.with_friction_lengths(0.0, 1e-4).unwrap();
    let scene = Scene::new(coin, surface, 9.81).unwrap();
    let launch = Launch {
        height_m: 0.01,
        velocity_m_s: Vector3::zeros(),
        axis: Vector3::x_axis(),
        spin_rad_s: Vector3::new(0.0, 0.0, 60.0),
    };
    let watch = watched(&scene, &patient(), &launch, 100.0, 0.3);
    let spin = |i: usize| watch.taken[i].spin_rad_s.z;
    let slowed = (spin(5) - spin(25)) / 0.2;
    let expected = 1e-4 * 9.81 / coin.transverse_gyration_m2();
    assert!(
        (slowed / expected - 1.0).abs() < 0.05,
        "{slowed} {expected}"
    );
}

//! Sustained contact of whole tosses against textbook motions.

use crate::common::{Moment, Start, Tosser};
use coinmc_core::{Ended, EventKind, Face, Scene};
use coinmc_oracle::{Model, Motion, textbook};
use coinmc_testkit::rolling_scene;
use coinmc_volumetric::{Decision, Settings};
use nalgebra::Vector3;

/// Integrates contact to 1e-10 and decides by energy only.
fn tight() -> Settings {
    Settings {
        decision: Decision::Energy,
        tolerance: 1e-10,
        stick_speed: 1e-6,
        smoothing_time: 1e-6,
        ..Settings::default()
    }
}

fn begin(scene: &Scene, motion: &Motion, settings: &Settings) -> (Ended, Vec<Moment>) {
    let start = Start {
        z: motion.position.z,
        velocity: motion.velocity,
        axis: motion.axis,
        spin: motion.spin,
    };
    let (outcome, moments) = Tosser::with(scene, settings).record(scene, &start.launch(scene));
    (outcome.ended, moments)
}

/// Steady precession persists: when the time limit ends the toss, or the motion is found to repeat
/// itself, the tilt is that of the start.
#[test]
fn steady_precession_stays_steady() {
    let mut checked = 0;
    for (ratio, tilt, circle) in [
        (0.1, 1.2, 0.0),
        (0.1, 1.0, -1.0),
        (0.85, 1.3, -0.7),
        (0.3, 1.4, -2.0),
    ] {
        let scene = rolling_scene(ratio, 0.0, 5.0, 0.0);
        let model = Model::new(&scene);
        let Some(motion) = textbook::precessing(&model, tilt, circle) else {
            continue;
        };
        if motion.energy(&model) < 1.05 {
            continue;
        }
        // some of these motions are unstable: rounding grows to 1e-6 within about 30 units of time
        let settings = Settings {
            time_limit: 10.0,
            ..tight()
        };
        let (ended, moments) = begin(&scene, &motion, &settings);
        let last = moments.last().expect("an end");
        assert!(
            matches!(ended, Ended::NeverSettles | Ended::TimeLimit),
            "{ratio} {tilt} {circle}: {ended:?} {moments:?}"
        );
        let off = (last.motion.axis.z - motion.axis.z).abs();
        println!(
            "{ratio} {tilt} {circle}: {ended:?} at {} off {off:e}",
            last.time
        );
        assert!(off < 1e-6, "{ratio} {tilt} {circle}: {off:e}");
        checked += 1;
    }
    assert!(checked >= 2, "{checked}");
}

/// A coin on its side, its axis along x.
fn lying(model: &Model, velocity: f64, spin: f64) -> Motion {
    Motion {
        position: Vector3::new(0.0, 0.0, model.radius),
        velocity: Vector3::new(0.0, velocity, 0.0),
        axis: Vector3::x(),
        spin: Vector3::new(spin, 0.0, 0.0),
    }
}

/// Slides, then rolls forever with 1/(1 + k) of the speed (two thirds). Instead of sticking it
/// creeps more slowly than `stick_speed`, 1e-6.
#[test]
fn a_sliding_cylinder_starts_to_roll() {
    for (ratio, mu) in [(1.0, 0.3), (3.0, 0.1), (10.0, 1.0)] {
        let scene = rolling_scene(ratio, 0.0, mu, 0.0);
        let model = Model::new(&scene);
        let (ended, moments) = begin(&scene, &lying(&model, 5.0, 0.0), &tight());
        assert_eq!(ended, Ended::NeverSettles, "{ratio} {mu}");
        let last = moments.last().expect("an end");
        let (time, speed) = textbook::slide_to_rolling(&model, 5.0);
        assert!((last.motion.velocity.y - speed).abs() < 1e-5, "{last:?}");
        assert!((last.motion.spin.x * model.radius + speed).abs() < 1e-5);
        // the last of the slip decays within a few times stick_speed/μ
        let late = last.time - time;
        assert!(late > -1e-5 && late < 1e-3, "{} {time}", last.time);
        // it is μ/2 of the square of the time behind a coin that keeps its first speed
        let way = 5.0 * time - 0.5 * mu * time * time + speed * (last.time - time);
        assert!(
            (last.motion.position.y - way).abs() < 1e-3,
            "{last:?} {way}"
        );
    }
}

/// Contour friction stops a rolling cylinder like a wheel, after v/(R·rate).
#[test]
fn a_rolling_cylinder_stops_like_a_wheel() {
    for ratio in [1.0, 3.0] {
        let scene = rolling_scene(ratio, 0.0, 0.3, 0.01);
        let model = Model::new(&scene);
        let spin = 3.0 / model.radius;
        let (ended, moments) = begin(&scene, &lying(&model, 3.0, -spin), &tight());
        assert_eq!(ended, Ended::Decided(Face::Side));
        let last = moments.last().expect("an end");
        let time = spin / textbook::wheel_deceleration(&model);
        assert!((last.time / time - 1.0).abs() < 1e-6, "{last:?} {time}");
    }
}

/// A rod that stands on its end and spins about its axis neither tips nor leaves the surface.
#[test]
fn a_rod_spun_on_end_stays_there() {
    let scene = rolling_scene(3.0, 0.0, 0.3, 0.01);
    let model = Model::new(&scene);
    let motion = Motion {
        position: Vector3::new(0.0, 0.0, model.half),
        velocity: Vector3::zeros(),
        axis: -Vector3::z(),
        spin: Vector3::new(0.0, 0.0, 5.0),
    };
    let (ended, moments) = begin(&scene, &motion, &Settings::default());
    assert_eq!(ended, Ended::Decided(Face::Tails), "{moments:?}");
    assert!(moments.iter().all(|m| m.kind != EventKind::LiftOff));
}

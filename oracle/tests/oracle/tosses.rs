//! Whole tosses of the stepper.

use coinmc_core::{Coin, Domain, Face, Launch, Preset, Scene, Stream, Surface};
use coinmc_oracle::{Model, Motion, StepperSettings, TimeStepper};
use coinmc_testkit::rolling_scene;
use nalgebra::{UnitVector3, Vector3};

fn launch(scene: &Scene, toss: u64) -> Launch {
    let stream = Stream::new(31, Domain::Launch, 0);
    let launches = Preset::Clean.distribution();
    launches.launch(&scene.coin, &mut stream.toss(toss))
}

fn stepper(scene: &Scene) -> TimeStepper {
    TimeStepper::new(scene, StepperSettings::default())
}

/// A coin dropped flat without spin is a ball: it bounces to e² of the height, again and again.
#[test]
fn a_flat_drop_bounces_like_a_ball() {
    let surface = Surface::new(0.7, 0.0).expect("a good surface");
    let coin = Coin::cylinder(0.5, 0.01).expect("a good coin");
    let scene = Scene::new(coin, surface, 9.81).expect("good gravity");
    let model = Model::new(&scene);
    let height = 4.0;
    let start = Motion {
        position: Vector3::new(0.0, 0.0, model.half + height),
        velocity: Vector3::zeros(),
        axis: Vector3::z(),
        spin: Vector3::zeros(),
    };
    // the fall and the first two bounces, each e times as long as the one before
    let fall = (2.0 * height).sqrt();
    let third = fall * (1.0 + 2.0 * 0.7 + 2.0 * 0.49);
    let (mut energy, mut speed) = (0.0, 0.0);
    stepper(&scene).follow(start, third + 0.2, |time, motion| {
        if time < third - 0.05 {
            energy = motion.energy(&model) - model.half;
        } else {
            speed = motion.velocity.z;
        }
    });
    let expected = height * libm::pow(0.7, 4.0);
    assert!((energy - expected).abs() < 1e-6, "{energy} {expected}");
    assert!(speed > 0.0);
}

/// Energy never grows by more than the coin sinks in and is lifted again. Newton's law itself may
/// gain; where it would, the substitute acts.
#[test]
fn nothing_gains_energy() {
    for (ratio, e) in [(0.25, 0.5), (0.85, 0.0), (0.85, 0.8), (2.0, 0.3)] {
        let scene = rolling_scene(ratio, e, 0.3, 0.01);
        let model = Model::new(&scene);
        for toss in 0..15 {
            let start = Motion::launched(&scene, &launch(&scene, toss));
            let mut energy = start.energy(&model);
            stepper(&scene).follow(start, 20.0, |_, motion| {
                let now = motion.energy(&model);
                assert!(now < energy + 1e-4, "{ratio} {e} {toss}: {energy} {now}");
                energy = now;
            });
        }
    }
}

/// The mirror image of a toss in the plane y = 0 and the one turned end for end land as they must
/// (single tosses are chaotic at e > 0, but rounding has not grown up at e = 0).
#[test]
fn mirrored_tosses_land_alike() {
    let scene = rolling_scene(0.85, 0.0, 0.3, 0.01);
    let mut stepper = stepper(&scene);
    let (mut differ, tosses) = (0, 40);
    for toss in 0..tosses {
        let launch = launch(&scene, toss);
        let face = stepper.toss(&launch).face;
        let (u, w) = (launch.axis, launch.spin_rad_s);
        let mirrored = Launch {
            axis: UnitVector3::new_unchecked(Vector3::new(u.x, -u.y, u.z)),
            spin_rad_s: Vector3::new(-w.x, w.y, -w.z),
            ..launch
        };
        let ended = Launch { axis: -u, ..launch };
        let swapped = match face {
            Some(Face::Heads) => Some(Face::Tails),
            Some(Face::Tails) => Some(Face::Heads),
            other => other,
        };
        differ += u32::from(stepper.toss(&mirrored).face != face);
        differ += u32::from(stepper.toss(&ended).face != swapped);
    }
    assert!(differ <= 1, "{differ} of {}", 2 * tosses);
}

/// Adhesion aside, a thick rod lands on its side and a thin disk does not.
#[test]
fn extreme_coins_land_as_they_must() {
    for (ratio, side) in [(0.02, false), (30.0, true)] {
        let scene = rolling_scene(ratio, 0.3, 0.3, 0.01);
        let mut stepper = stepper(&scene);
        for toss in 0..20 {
            let face = stepper.toss(&launch(&scene, toss)).face;
            assert_eq!(face == Some(Face::Side), side, "{ratio} {toss}: {face:?}");
        }
    }
}

/// P(side) of an earlier study of ours (± .0007) in a scene without restitution: within 3 standard errors
/// of the tosses made (false alarms with other seeds: 3e-3) and .002 for the step.
fn meets(ratio: f64, rho: f64, known: f64, tosses: u64) {
    let scene = rolling_scene(ratio, 0.0, 0.3, rho);
    let mut stepper = stepper(&scene);
    let sides = (0..tosses)
        .filter(|&toss| stepper.toss(&launch(&scene, toss)).face == Some(Face::Side))
        .count();
    let p = sides as f64 / tosses as f64;
    let error = (known * (1.0 - known) / tosses as f64).sqrt();
    assert!(
        (p - known).abs() < 3.0 * error + 0.002,
        "{ratio}: {p} ± {error}"
    );
}

#[test]
fn a_coin_without_restitution_meets_an_earlier_value() {
    meets(0.85, 0.01, 0.0611, 1500);
}

/// By energy alone a thick coin with little rolling friction takes 250 ms a toss.
#[test]
fn a_thick_coin_without_restitution_meets_an_earlier_value() {
    meets(2.0, 0.003, 0.9061, 80);
}

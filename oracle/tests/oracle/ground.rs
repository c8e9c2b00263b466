//! The statistics of the random ground, and the coin on it.

use crate::common::in_contact;
use coinmc_core::{Coin, Face, Scene, Surface};
use coinmc_oracle::{
    Ending, Ground, Model, Motion, RoughSettings, RoughStepper, Start, StepperSettings,
    TimeStepper, textbook,
};
use coinmc_testkit::{Dice, rolling_scene};
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// A coin like 1 euro on a hard surface.
fn euro() -> Scene {
    let coin = Coin::cylinder(0.2, 0.0116).expect("positive");
    let surface = Surface::new(0.5, 0.3).and_then(|s| s.with_friction_lengths(5e-5, 5e-6));
    Scene::new(coin, surface.expect("in range"), 9.806_65).expect("positive")
}

/// Variance, rms slopes, correlation at ℓ and 2ℓ over many grounds, far apart on each: as stated.
#[test]
fn the_ground_has_the_stated_statistics() {
    let (slope, length) = (0.05, 0.7);
    let (mut n, mut sums) = (0.0, [0.0; 6]);
    for seed in 0..60 {
        let mut ground = Ground::new(slope, length, seed);
        for place in 0..400 {
            let mut dice = Dice::new(seed, place);
            let (x, y) = (dice.between(-1e3, 1e3), dice.between(-1e3, 1e3));
            let (sin, cos) = libm::sincos(dice.between(0.0, TAU));
            let here = ground.at(x, y);
            let mut product = |r: f64| here.height * ground.at(x + r * cos, y + r * sin).height;
            let values = [
                here.height * here.height,
                product(length),
                product(2.0 * length),
                here.gradient[0].powi(2),
                here.gradient[1].powi(2),
                here.curvature[0].powi(2),
            ];
            for (sum, value) in sums.iter_mut().zip(values) {
                *sum += value;
            }
            n += 1.0;
        }
    }
    let variance = (slope * length).powi(2);
    let expected = [
        variance,
        variance * libm::exp(-0.5),
        variance * libm::exp(-2.0),
        slope * slope,
        slope * slope,
        3.0 * (slope / length).powi(2),
    ];
    let scales = [
        variance,
        variance,
        variance,
        expected[3],
        expected[4],
        expected[5],
    ];
    for ((sum, expected), scale) in sums.iter().zip(expected).zip(scales) {
        // of 24,000 squares of normal variables: three standard errors are 2.7 %
        assert!(
            (sum / n - expected).abs() < 0.03 * scale,
            "{} {expected}",
            sum / n
        );
    }
}

/// A profile crosses the mean upwards once in λ = 2πℓ (Rice).
#[test]
fn up_crossings_are_a_wavelength_apart() {
    let (length, step) = (0.02, 0.004);
    let (mut crossings, mut way) = (0, 0.0);
    for seed in 0..40 {
        let mut ground = Ground::new(0.03, length, seed);
        let (sin, cos) = libm::sincos(f64::from(u32::try_from(seed).expect("small")));
        let mut last = f64::NAN;
        for index in 0..4000 {
            let r = step * f64::from(index);
            let height = ground.at(r * cos, r * sin).height;
            crossings += i32::from(last < 0.0 && height >= 0.0);
            last = height;
            way += step;
        }
    }
    let distance = way / f64::from(crossings) / (TAU * length);
    assert!((distance - 1.0).abs() < 0.03, "{distance}");
}

/// The interpolant is the sum of waves within 1e-3 σ, and its derivatives are its own: exact but for
/// the differences' truncation.
#[test]
fn the_grid_hardly_changes_the_ground() {
    let mut ground = Ground::new(0.1, 0.3, 5);
    let (sigma, tiny) = (ground.deviation(), 1e-6);
    for place in 0..2000 {
        let mut dice = Dice::new(3, place);
        let (x, y) = (dice.between(-50.0, 50.0), dice.between(-50.0, 50.0));
        let here = ground.at(x, y);
        assert!((here.height - ground.sum(x, y)).abs() < 2e-3 * sigma);
        let east = ground.at(x + tiny, y);
        let north = ground.at(x, y + tiny);
        let slopes = [east.height - here.height, north.height - here.height].map(|d| d / tiny);
        for (difference, slope) in slopes.iter().zip(here.gradient) {
            assert!((difference - slope).abs() < 1e-5, "{difference} {slope}");
        }
        let bends = [
            east.gradient[0] - here.gradient[0],
            north.gradient[0] - here.gradient[0],
            north.gradient[1] - here.gradient[1],
        ];
        for (difference, bend) in bends.iter().zip(here.curvature) {
            // the second derivatives jump at the edges of cells
            assert!(
                (difference / tiny - bend).abs() < 0.05,
                "{difference:e} {bend}"
            );
        }
    }
}

/// Flat ground is the plane of the smooth stepper: the motion is the same within both schemes' error,
/// rolling, sliding and bouncing over.
#[test]
fn flat_ground_is_the_plane() {
    let scene = rolling_scene(0.3, 0.5, 0.3, 0.005);
    let model = Model::new(&scene);
    let step = 1e-3;
    for trial in 0..20 {
        let mut dice = Dice::new(21, trial);
        let start = in_contact(&mut dice, &model, 0.8);
        let time = 0.5;
        // the last state before the time, carried on freely for the rest, less than a step in contact
        let end = |last: &mut Motion, t: f64, now: &Motion| {
            if t <= time {
                *last = *now;
                last.fly(&model, time - t);
            }
        };
        let (mut smooth, mut rough) = (start, start);
        let settings = StepperSettings {
            step,
            ..StepperSettings::default()
        };
        TimeStepper::new(&scene, settings).follow(start, time, |t, m| end(&mut smooth, t, m));
        let settings = RoughSettings {
            step,
            ..RoughSettings::default()
        };
        let mut ground = Ground::new(0.0, 1.0, 1);
        RoughStepper::new(&scene, settings)
            .follow(start, &mut ground, time, |t, m| end(&mut rough, t, m));
        let apart = (smooth.axis - rough.axis).norm() + (smooth.position - rough.position).norm();
        assert!(apart < step, "{trial}: {apart}");
    }
}

/// Whole tosses onto flat ground end as those of the smooth stepper, but for a few that are chaotic.
#[test]
fn tosses_onto_flat_ground_end_alike() {
    let scene = rolling_scene(0.5, 0.3, 0.3, 0.01);
    let mut smooth = TimeStepper::new(&scene, StepperSettings::default());
    let mut rough = RoughStepper::new(&scene, RoughSettings::default());
    let (mut same, mut sides, tosses) = (0, [0, 0], 150);
    for toss in 0..tosses {
        let mut dice = Dice::new(2, toss);
        let launch = coinmc_core::Launch {
            height_m: 0.03,
            velocity_m_s: Vector3::zeros(),
            axis: nalgebra::UnitVector3::new_normalize(dice.direction()),
            spin_rad_s: dice.vector(20.0),
        };
        let mut ground = Ground::new(0.0, 1.0, toss);
        let faces = [
            smooth.toss(&launch).face,
            rough.toss(&launch, &mut ground).face,
        ];
        same += u64::from(faces[0] == faces[1]);
        for (count, face) in sides.iter_mut().zip(faces) {
            *count += i32::from(face == Some(Face::Side));
        }
    }
    assert!(same * 10 > tosses * 9, "{same} of {tosses}, {sides:?}");
    assert!((sides[0] - sides[1]).abs() < 12, "{sides:?}");
}

/// On waves much longer than itself a coin on its side rolls as on an inclined plane, and slides as
/// on one along its axis.
#[test]
fn long_waves_are_an_incline() {
    let mut ground = Ground::new(0.1, 1e6, 4);
    let here = ground.at(0.0, 0.0);
    let [gx, gy] = here.gradient;
    let normal = Vector3::new(-gx, -gy, 1.0).normalize();
    let slope = (gx * gx + gy * gy).sqrt();
    let downhill = -Vector3::new(gx, gy, slope * slope).normalize();
    let (sin, cos) = libm::sincos(libm::atan(slope));
    for rolls in [true, false] {
        let mu = if rolls { 0.5 } else { 0.02 };
        let scene = rolling_scene(1.0, 0.0, mu, 0.01);
        let model = Model::new(&scene);
        let axis = if rolls {
            normal.cross(&downhill)
        } else {
            downhill
        };
        let start = Motion {
            position: Vector3::z() * here.height + normal * model.radius,
            velocity: Vector3::zeros(),
            axis,
            spin: Vector3::zeros(),
        };
        let (time, mut end, mut last) = (2.0, start, 0.0);
        RoughStepper::new(&scene, RoughSettings::default()).follow(
            start,
            &mut ground,
            time,
            |t, motion| (end, last) = (*motion, t),
        );
        let acceleration = if rolls {
            let inertia = 1.0 + model.axial / model.radius.powi(2);
            sin / inertia - cos * textbook::wheel_deceleration(&model) * model.radius
        } else {
            sin - mu * cos
        };
        let speed = end.velocity.dot(&downhill) / (acceleration * last);
        assert!((speed - 1.0).abs() < 1e-3, "{rolls}: {speed}");
    }
}

/// Rolling over rough ground, with hops and impacts: energy never grows and the rims never sink in.
#[test]
fn rolling_neither_gains_energy_nor_sinks_in() {
    let scene = euro();
    for (slope, wavelength_m) in [(0.01, 1e-3), (0.03, 3e-3), (0.03, 10e-3)] {
        for seed in 0..3 {
            let mut stepper = RoughStepper::new(&scene, RoughSettings::default());
            let mut probe = RoughStepper::new(&scene, RoughSettings::default());
            let mut ground = stepper.ground(slope, wavelength_m, seed);
            let launch = Start::Rolling(0.3).launch(&scene.coin, 5e-4);
            let mut start = Motion::launched(&scene, &launch);
            start.position.z -= stepper.gap(&start, &mut ground);
            let model = *stepper.model();
            let mut energy = start.energy(&model);
            let mut places = Vec::new();
            let history = stepper.follow(start, &mut ground, 10.0, |_, motion| {
                let now = motion.energy(&model);
                assert!(
                    now <= energy + 1e-12,
                    "{slope} {wavelength_m}: {now} {energy}"
                );
                energy = now;
                places.push(*motion);
            });
            assert!(
                history.gained <= 1e-12 && history.returned < 1e-3,
                "{history:?}"
            );
            for motion in places.iter().step_by(37) {
                let gap = probe.gap(motion, &mut ground);
                assert!(gap > -1e-6, "{slope} {wavelength_m}: {gap}");
            }
        }
    }
}

/// A coin placed on its side on nearly level ground stays there, and its rest ends the toss even where
/// energy cannot decide.
#[test]
fn a_coin_at_rest_is_found_to_rest() {
    let scene = euro();
    let mut stepper = RoughStepper::new(&scene, RoughSettings::default());
    let launch = Start::Rolling(0.0).launch(&scene.coin, 1e-3);
    let mut ground = stepper.ground(0.003, 50e-3, 3);
    // its well is less deep than 5σ
    assert!(5.0 * ground.deviation() > 1.0 - stepper.model().radius);
    let history = stepper.placed(&launch, &mut ground);
    assert_eq!(history.face, Some(Face::Side));
    assert_eq!(history.ending, Ending::Rest);
}

/// A toss is a function of its launch and the ground's seed.
#[test]
fn tosses_repeat() {
    let scene = euro();
    let launch = Start::Rolling(0.3).launch(&scene.coin, 1e-4);
    let run = |seed| {
        let mut stepper = RoughStepper::new(&scene, RoughSettings::default());
        let mut ground = stepper.ground(0.03, 3e-3, seed);
        stepper.placed(&launch, &mut ground)
    };
    assert_eq!(run(1), run(1));
    assert_ne!(run(1), run(2));
}

//! Every launch ends in bounded time, without a panic, and is counted correctly.

use crate::common::Tosser;
use coinmc_core::{Coin, Ended, Launch, Scene, Surface};
use coinmc_testkit::{Dice, is_finite, replace_two, rolling_scene, within_two_minutes};
use coinmc_volumetric::{Law, Settings};
use nalgebra::{UnitVector3, Vector3};

/// A random toss: ratio 1e-4 to 1e4, radius 1e-6 to 1e3 m, spin up to 1e5 rad/s, heights up to 1e3
/// R; e, μ and ρ at and between the ends of their ranges. Scenes in which a rolling or bouncing
/// coin loses no energy are left out, because some of their tosses never end.
///
/// `tame` restricts them to tosses whose contact can be followed to its end: a coin that turns n
/// times as fast as it topples needs about n²/μ or n²R/ρ steps until friction has slowed it down.
fn stress(trial: u64, tame: bool) -> (Scene, Launch, Law) {
    let mut dice = Dice::new(130, trial);
    let radius = dice.scale(1e-6, 1e3);
    let ratio = match dice.pick(&[0, 1, 2, 3]) {
        0 if !tame => dice.pick(&[1e-4, 1e4]),
        1 => dice.scale(0.1, 4.0),
        _ if tame => dice.scale(0.02, 50.0),
        _ => dice.scale(1e-4, 1e4),
    };
    let e = match dice.pick(&[0, 1, 2, 3]) {
        0 => 0.0,
        1 => dice.between(0.9, 0.999),
        _ => dice.between(0.0, 0.95),
    };
    let mu = match dice.pick(&[0, 1, 2, 3]) {
        0 => dice.pick(&[0.0, 10.0]),
        1 => dice.scale(1e-6, 10.0),
        2 => dice.between(1.0, 10.0),
        _ => dice.between(0.0, 1.0),
    };
    let least = if tame { 1e-2 } else { 1e-4 };
    let mut length = || radius * dice.pick(&[0.1, least, 1e-2]) * dice.between(0.1, 1.0);
    let (contour, pivoting) = (length(), length());
    let coin = Coin::cylinder(ratio, radius).expect("a valid coin");
    let surface = Surface::new(e, mu)
        .and_then(|surface| surface.with_friction_lengths(contour, pivoting))
        .expect("a valid surface");
    let scene = Scene::new(coin, surface, Scene::STANDARD_GRAVITY_M_S2).expect("valid gravity");
    let height = match dice.pick(&[0, 1, 2]) {
        0 => 0.0,
        _ if tame => radius * dice.scale(1e-3, 30.0),
        1 => 1e3 * radius * dice.between(0.0, 1.0),
        _ => radius * dice.scale(1e-3, 1e3),
    };
    let spin = match dice.pick(&[0, 1, 2, 3]) {
        0 => Vector3::zeros(),
        _ if tame => dice.vector(3.0) / scene.time_scale_s(),
        1 => dice.vector(1e5),
        2 => dice.direction() * dice.scale(1e-6, 1e5),
        _ => dice.vector(10.0) / scene.time_scale_s(),
    };
    let axis = match dice.pick(&[0, 1, 2, 3]) {
        0 => dice.pick(&[
            Vector3::z(),
            -Vector3::z(),
            Vector3::x(),
            Vector3::new(0.6, 0.0, 0.8),
        ]),
        _ => dice.direction(),
    };
    let velocity = match dice.pick(&[0, 1]) {
        0 => Vector3::zeros(),
        _ => dice.vector(3.0) * (scene.coin.rim_distance_m() / scene.time_scale_s()),
    };
    let launch = Launch {
        height_m: height,
        velocity_m_s: velocity,
        axis: UnitVector3::new_unchecked(axis),
        spin_rad_s: spin,
    };
    (scene, launch, Law::ALL[(trial % 3) as usize])
}

#[test]
fn all_tame_tosses_are_decided() {
    within_two_minutes(|| {
        let mut undecided = Vec::new();
        for trial in 0..5_000 {
            let (scene, launch, law) = stress(trial, true);
            let outcome = Tosser::of(&scene, law).toss(&launch);
            if outcome.face().is_none() {
                undecided.push((trial, law, outcome));
            }
        }
        assert!(undecided.is_empty(), "{undecided:#?}");
    });
}

#[test]
fn all_tosses_end_and_are_counted() {
    within_two_minutes(|| {
        let (mut limited, mut jams) = (0_u64, 0_u64);
        for trial in 0..1_000 {
            let (scene, launch, law) = stress(trial, false);
            let settings = Settings {
                law,
                max_impacts: 5_000,
                max_steps: 5_000,
                ..Settings::default()
            };
            let outcome = Tosser::with(&scene, &settings).toss(&launch);
            jams += u64::from(outcome.jams);
            limited += u64::from(outcome.ended == Ended::ImpactLimit);
            assert!(
                outcome.face().is_some() || outcome.ended == Ended::ImpactLimit,
                "{trial} {law:?} {outcome:?}"
            );
        }
        // what the tame tosses leave out: huge spins and very low friction
        assert!(limited < 400, "{limited}");
        assert!(jams > 0, "no Painlevé configuration in the sample");
    });
}

fn extreme(dice: &mut Dice) -> Launch {
    let [height_m, vx, vy, vz, wx, wy, wz] = replace_two(dice);
    let axis = match dice.pick(&[0, 1, 2, 3]) {
        0 => Vector3::z(),
        1 => Vector3::x(),
        2 => Vector3::new(1e-17, 0.0, -1.0),
        _ => dice.direction(),
    };
    Launch {
        height_m,
        velocity_m_s: Vector3::new(vx, vy, vz),
        axis: UnitVector3::new_unchecked(axis),
        spin_rad_s: Vector3::new(wx, wy, wz),
    }
}

#[test]
fn extreme_launches_end_and_launches_that_are_not_finite_fail() {
    within_two_minutes(|| {
        let mut ends = [0_u32; 5];
        for trial in 0..20_000 {
            let mut dice = Dice::new(131, trial);
            let ratio = dice.pick(&[1e-6, 0.01, 1.0, 2.0, 100.0, 1e6]);
            let restitution = dice.pick(&[0.0, 0.5, 0.99, 1.0]);
            let friction = dice.pick(&[0.0, 0.3, 2.0, 10.0, 1e4]);
            let rho = dice.pick(&[0.0, 0.01, 0.1]);
            let settings = Settings {
                law: Law::ALL[(trial % 3) as usize],
                max_impacts: 1000,
                max_steps: 10_000,
                ..Settings::default()
            };
            let engine = Tosser::with(&rolling_scene(ratio, restitution, friction, rho), &settings);
            let launch = extreme(&mut dice);
            let outcome = engine.toss(&launch);
            let end = match outcome.ended {
                Ended::Decided(_) => 0,
                Ended::TimeLimit => 1,
                Ended::ImpactLimit => 2,
                Ended::Failed => 3,
                Ended::NeverSettles | Ended::Left => 4,
            };
            ends[end] += 1;
            if !is_finite(&launch) {
                assert_eq!(outcome.ended, Ended::Failed, "{trial}: {launch:?}");
            }
            assert!(outcome.impacts <= settings.max_impacts, "{trial}");
        }
        println!("{ends:?}");
        assert!(ends[0] > 1000 && ends[2] > 0 && ends[3] > 1000, "{ends:?}");
    });
}

/// An axis that is NaN has no face.
#[test]
fn an_axis_of_nan_fails() {
    for (height_m, restitution) in [(0.0, 0.5), (0.005, 0.5), (1.0, 0.5), (1.0, 0.0)] {
        for axis in [
            Vector3::new(f64::NAN, 0.0, f64::NAN),
            Vector3::new(0.0, 0.0, f64::NAN),
            Vector3::new(f64::NAN, 0.0, 1.0),
        ] {
            let launch = Launch {
                height_m,
                velocity_m_s: Vector3::zeros(),
                axis: UnitVector3::new_unchecked(axis),
                spin_rad_s: Vector3::zeros(),
            };
            let outcome = Tosser::new(&rolling_scene(1.0, restitution, 0.3, 0.01)).toss(&launch);
            assert_eq!(outcome.ended, Ended::Failed, "{axis:?} from {height_m} m");
        }
    }
}

//! Heads and tails are alike, and so are coins of any size.

use crate::common::{Tosser, is_side, launch, paired, quick, scene, table1};
use coinmc_core::{Coin, Drag, Face, Launch, Preset, Scene};
use coinmc_rapier::Settings;
use nalgebra::UnitVector3;

/// u → −u gives the mirrored face and the same account, to the last bit.
#[test]
fn heads_and_tails_exchange_exactly() {
    let coarse = Settings {
        step_s: 0.02,
        ..Settings::default()
    };
    for (scene, preset, settings) in [
        (scene(0.5, 0.5, 0.3), Preset::Clean, quick()),
        (scene(2.0, 0.3, 0.0), Preset::Clean, quick()),
        (table1(0.25), Preset::Table1, coarse),
    ] {
        let mut tosser = Tosser::new(&scene, &settings);
        for toss in 0..250 {
            let launch = launch(preset, &scene, 20, toss);
            let turned = Launch {
                axis: UnitVector3::new_unchecked(-launch.axis.into_inner()),
                ..launch
            };
            let (one, other) = (tosser.examine(&launch), tosser.examine(&turned));
            let mirrored = one.outcome.face().map(|face| match face {
                Face::Heads => Face::Tails,
                Face::Tails => Face::Heads,
                Face::Side => Face::Side,
            });
            assert_eq!(other.outcome.face(), mirrored, "{toss}");
            assert_eq!((one.steps, one.depth), (other.steps, other.depth), "{toss}");
        }
    }
}

/// The scene `length` times as large where time runs `time` times as slowly, the step with it.
fn scaled(scene: &Scene, settings: &Settings, length: f64, time: f64) -> (Scene, Settings) {
    let surface = &scene.surface;
    let threshold = surface.restitution_threshold_m_s() * length / time;
    let surface = surface
        .with_friction_lengths(
            surface.rolling_friction_m() * length,
            surface.pivoting_friction_m() * length,
        )
        .and_then(|surface| surface.with_restitution_threshold(threshold))
        .unwrap();
    let coin = Coin::cylinder(scene.coin.ratio(), scene.coin.radius_m() * length).unwrap();
    let gravity = scene.gravity_m_s2() * length / (time * time);
    let drag = scene.drag();
    let drag = Drag::new(drag.linear_per_s() / time, drag.angular_per_s() / time).unwrap();
    let other = Scene::new(coin, surface, gravity)
        .unwrap()
        .with_drag(drag)
        .with_gyroscopic_torque(scene.has_gyroscopic_torque());
    let settings = Settings {
        step_s: settings.step_s * time,
        ..*settings
    };
    (other, settings)
}

fn scaled_launch(launch: &Launch, length: f64, time: f64) -> Launch {
    Launch {
        height_m: launch.height_m * length,
        velocity_m_s: launch.velocity_m_s * (length / time),
        spin_rad_s: launch.spin_rad_s / time,
        ..*launch
    }
}

/// Powers of two change no bit.
#[test]
fn a_coin_of_another_size_is_the_same_computation() {
    let coarse = Settings {
        step_s: 0.02,
        ..Settings::default()
    };
    for (scene, preset, settings) in [
        (scene(0.7, 0.5, 0.3), Preset::Clean, quick()),
        (table1(1.0), Preset::Table1, coarse),
    ] {
        let mut reference = Tosser::new(&scene, &settings);
        for (length, time) in [(4.0, 2.0), (0.25, 0.5), (1024.0, 1.0)] {
            let (other, settings) = scaled(&scene, &settings, length, time);
            let mut tosser = Tosser::new(&other, &settings);
            for toss in 0..80 {
                let launch = launch(preset, &scene, 21, toss);
                let (one, other) = (
                    reference.examine(&launch),
                    tosser.examine(&scaled_launch(&launch, length, time)),
                );
                assert_eq!(one, other, "{length} {time} {toss}");
            }
        }
    }
}

/// A hundredfold length rounds otherwise, which the bounces amplify: the shares agree within 5
/// standard errors of the paired difference (false alarms 6e-7).
#[test]
fn a_coin_of_a_centimetre_and_one_of_a_metre_agree() {
    let scene = scene(1.0, 0.5, 0.3);
    let (length, time) = (100.0, 10.0);
    let (other, settings) = scaled(&scene, &quick(), length, time);
    let (mut small, mut large) = (
        Tosser::new(&scene, &quick()),
        Tosser::new(&other, &settings),
    );
    let differences: Vec<f64> = (0..400)
        .map(|toss| {
            let launch = launch(Preset::Clean, &scene, 22, toss);
            let large = large.toss(&scaled_launch(&launch, length, time));
            is_side(&small.toss(&launch)) - is_side(&large)
        })
        .collect();
    let (mean, error) = paired(&differences);
    assert!(mean.abs() <= 5.0 * error, "{mean} ± {error}");
}

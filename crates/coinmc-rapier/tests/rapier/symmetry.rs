//! Heads and tails are alike, and so are coins of any size.

use crate::common::{Tosser, quick};
use coinmc_core::{Preset, Scene};
use coinmc_rapier::Settings;
use coinmc_testkit::conformance::flipped;
use coinmc_testkit::{Scale, paired, preset_launch, scene, side, table1, turned};

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
            let launch = preset_launch(preset, &scene, 20, toss);
            let (one, other) = (tosser.examine(&launch), tosser.examine(&flipped(&launch)));
            assert_eq!(other.outcome.face(), turned(one.outcome.face()), "{toss}");
            assert_eq!((one.steps, one.depth), (other.steps, other.depth), "{toss}");
        }
    }
}

/// Scene, launches and step in other units.
fn scaled(scene: &Scene, settings: &Settings, scale: Scale) -> (Scene, Settings) {
    let settings = Settings {
        step_s: settings.step_s * scale.time,
        ..*settings
    };
    (scale.scene(scene), settings)
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
            let scale = Scale { length, time };
            let (other, settings) = scaled(&scene, &settings, scale);
            let mut tosser = Tosser::new(&other, &settings);
            for toss in 0..80 {
                let launch = preset_launch(preset, &scene, 21, toss);
                let (one, other) = (
                    reference.examine(&launch),
                    tosser.examine(&scale.launch(&launch)),
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
    let scale = Scale {
        length: 100.0,
        time: 10.0,
    };
    let (other, settings) = scaled(&scene, &quick(), scale);
    let (mut small, mut large) = (
        Tosser::new(&scene, &quick()),
        Tosser::new(&other, &settings),
    );
    let differences: Vec<f64> = (0..400)
        .map(|toss| {
            let launch = preset_launch(Preset::Clean, &scene, 22, toss);
            let large = large.toss(&scale.launch(&launch));
            side(&small.toss(&launch)) - side(&large)
        })
        .collect();
    let (mean, error) = paired(&differences);
    assert!(mean.abs() <= 5.0 * error, "{mean} ± {error}");
}

//! A toss is the same toss whatever the world did before it, and whoever makes it.

use crate::common::{Tosser, quick};
use coinmc_core::{Engine, Launch, Preset, Scene};
use coinmc_rapier::{Account, Flight, FrictionModel, Gyroscopic, RapierEngine, Settings};
use coinmc_testkit::{conformance, count_until, preset_launch, scene, table1};
use nalgebra::Vector3;

fn scenes() -> [(Scene, Preset, Settings); 4] {
    let steps = Settings {
        flight: Flight::Steps,
        ..quick()
    };
    let coarse = Settings {
        step_s: 0.02,
        ..Settings::default()
    };
    [
        (scene(0.5, 0.5, 0.3), Preset::Clean, quick()),
        (scene(2.0, 0.0, 0.3), Preset::Clean, quick()),
        (scene(2.0, 0.8, 1.0), Preset::Clean, steps),
        (table1(1.0), Preset::Table1, coarse),
    ]
}

/// To the last bit: every count and the energy and depth of the account.
#[test]
fn what_went_before_does_not_matter() {
    let mut tosses = 0;
    for (scene, preset, settings) in scenes() {
        let mut batch = Tosser::new(&scene, &settings);
        let together: Vec<Account> = (0..600)
            .map(|toss| batch.examine(&preset_launch(preset, &scene, 10, toss)))
            .collect();
        // backwards, so that every toss has other predecessors; every third in a world of its own
        let mut other = Tosser::new(&scene, &settings);
        for (toss, expected) in together.iter().enumerate().rev() {
            if toss % 3 == 0 {
                other = Tosser::new(&scene, &settings);
            }
            let alone = other.examine(&preset_launch(preset, &scene, 10, toss as u64));
            assert_eq!(alone, *expected, "toss {toss} of {preset}");
            tosses += 1;
        }
    }
    assert_eq!(tosses, 2400);
}

/// A twentieth of these goes where no coin goes: far up, or faster than any number of steps can bear.
fn launches(scene: &Scene, preset: Preset, count: u64) -> Vec<Launch> {
    let wild = |toss: u64, good: Launch| match toss % 60 {
        17 => Launch {
            height_m: 1e300,
            ..good
        },
        37 => Launch {
            spin_rad_s: Vector3::repeat(1e30),
            ..good
        },
        57 => Launch {
            velocity_m_s: Vector3::new(1e100, 0.0, -1e150),
            ..good
        },
        _ => good,
    };
    (0..count)
        .map(|toss| wild(toss, preset_launch(preset, scene, 12, toss)))
        .collect()
}

/// To the last bit: the coins of a world are worked on in the lanes of one register, and with
/// whatever neighbours, every account is that of the toss that has a world to itself.
#[test]
fn a_toss_alone_is_the_toss_among_others() {
    let simplified = Settings {
        friction_model: FrictionModel::Simplified,
        gyroscopic: Gyroscopic::Rapier,
        flight: Flight::Off,
        max_steps: 2000,
        ..quick()
    };
    let extra = (scene(0.7, 0.6, 0.2), Preset::Clean, simplified);
    for (scene, preset, settings) in scenes().into_iter().chain([extra]) {
        let launches = launches(&scene, preset, 120);
        let mut alone = Tosser::new(&scene, &settings);
        let expected: Vec<Account> = launches.iter().map(|l| alone.examine(l)).collect();
        for tosses_at_once in [1, 3, 32, 300] {
            let settings = Settings {
                tosses_at_once,
                ..settings
            };
            let mut many = Tosser::new(&scene, &settings);
            for (number, account) in many.examine_all(&launches).iter().enumerate() {
                let what = format!("{number} of {tosses_at_once} at once");
                // as text, which tells every bit apart and holds what is no number for the same
                let [one, other] = [account, &expected[number]].map(|a| format!("{a:?}"));
                assert_eq!(one, other, "{what}");
            }
        }
    }
}

/// Who has seen enough breaks off; the world is as good as new.
#[test]
fn a_batch_that_breaks_off_leaves_nothing_behind() {
    let (scene, preset, settings) = scenes()[0];
    let launches = launches(&scene, preset, 200);
    let engine = RapierEngine::new(&scene, &settings).unwrap();
    let mut workspace = engine.workspace();
    let seen = count_until(&engine, &mut workspace, launches.iter().copied(), 10);
    assert_eq!(seen, 10);
    let mut fresh = Tosser::new(&scene, &settings);
    for launch in &launches[..20] {
        let account = engine.examine(&mut workspace, launch, &mut ());
        assert_eq!(account, fresh.examine(launch));
    }
}

#[test]
fn outcomes_depend_on_the_launch_alone() {
    let (scene, preset, settings) = scenes()[0];
    let launch = |toss| preset_launch(preset, &scene, 11, toss);
    let launches: Vec<Launch> = (0..800).map(launch).collect();
    let engine = RapierEngine::new(&scene, &settings).unwrap();
    conformance::outcomes_depend_on_the_launch_alone(&engine, &launches);
}

//! Rapier in single precision, a build of its own: `cargo test -p coinmc-rapier --features f32 single::`.

use crate::common::{Tosser, is_side, launch, paired, quick, scene, table1};
use coinmc_core::{Launch, Preset, Scene};
use coinmc_rapier::{Account, Precision, Settings};

fn scenes() -> [(Scene, Preset, Settings); 2] {
    let coarse = Settings {
        step_s: 0.02,
        ..Settings::default()
    };
    [
        (scene(1.0, 0.5, 0.3), Preset::Clean, quick()),
        (table1(1.0), Preset::Table1, coarse),
    ]
}

fn launches(scene: &Scene, preset: Preset) -> Vec<Launch> {
    (0..500)
        .map(|toss| launch(preset, scene, 90, toss))
        .collect()
}

fn in_precision(precision: Precision, settings: &Settings) -> Settings {
    Settings {
        precision,
        ..*settings
    }
}

/// Single tosses change, shares do not: within 5 standard errors of the paired difference (false
/// alarms 6e-7 each), and no toss more fails.
#[test]
fn statistics_are_those_of_double_precision() {
    for (scene, preset, settings) in scenes() {
        let launches = launches(&scene, preset);
        let [double, single] = [Precision::F64, Precision::F32].map(|precision| {
            let settings = in_precision(precision, &settings);
            Tosser::new(&scene, &settings).examine_all(&launches)
        });
        let sides = |a: &Account| is_side(&a.outcome);
        let differences: Vec<f64> = single
            .iter()
            .zip(&double)
            .map(|(one, other)| sides(one) - sides(other))
            .collect();
        let (mean, error) = paired(&differences);
        println!("{preset}: {mean} ± {error}");
        assert!(mean.abs() <= 5.0 * error, "{preset}: {mean} ± {error}");
        let changed = differences.iter().filter(|d| **d != 0.0).count();
        assert!(changed > 0, "the same arithmetic?");
        let failed = |tosses: &[Account]| tosses.iter().filter(|a| a.flaw.is_some()).count();
        assert!(failed(&single) <= failed(&double) + 10);
    }
}

/// To the last bit, as in double precision.
#[test]
fn a_toss_alone_is_the_toss_among_others() {
    for (scene, preset, settings) in scenes() {
        let settings = in_precision(Precision::F32, &settings);
        let launches = &launches(&scene, preset)[..150];
        let mut tosser = Tosser::new(&scene, &settings);
        let together = tosser.examine_all(launches);
        for (launch, expected) in launches.iter().zip(&together) {
            assert_eq!(tosser.examine(launch), *expected);
        }
    }
}

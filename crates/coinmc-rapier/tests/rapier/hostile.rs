//! Any launch at all ends, without a panic, under the right count.

use crate::common::{Tosser, quick};
use coinmc_core::{Coin, Ended, Landing, Launch, Preset, Scene, Surface};
use coinmc_rapier::{Flaw, Flight, Settings, SettingsError};
use coinmc_testkit::{preset_launch, scene};
use nalgebra::{UnitVector3, Vector3};

fn brief() -> Settings {
    Settings {
        max_steps: 300,
        ..quick()
    }
}

#[test]
fn what_is_no_number_is_counted_as_failed() {
    let scene = scene(1.0, 0.5, 0.3);
    let good = preset_launch(Preset::Clean, &scene, 30, 0);
    for flight in Flight::ALL {
        let mut tosser = Tosser::new(&scene, &Settings { flight, ..brief() });
        let expected = tosser.examine(&good);
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let vector = Vector3::new(0.0, bad, 0.0);
            let launches = [
                Launch {
                    height_m: bad,
                    ..good
                },
                Launch {
                    velocity_m_s: vector,
                    ..good
                },
                Launch {
                    spin_rad_s: vector,
                    ..good
                },
                Launch {
                    axis: UnitVector3::new_unchecked(vector),
                    ..good
                },
            ];
            for launch in launches {
                let account = tosser.examine(&launch);
                assert_eq!(account.outcome.ended, Ended::Failed, "{launch:?}");
                assert_eq!(account.flaw, Some(Flaw::NotFinite));
                assert_eq!(tosser.examine(&good), expected, "it left something behind");
            }
        }
    }
}

#[test]
fn huge_and_tiny_numbers_end() {
    let extremes = [0.0, 1e-300, 1e-30, 1e-9, 1.0, 1e9, 1e30, 1e150, 1e300];
    for (ratio, radius) in [(1e-4, 0.01), (1.0, 1e-6), (1.0, 1e3), (1e4, 0.01)] {
        let coin = Coin::cylinder(ratio, radius).unwrap();
        let scene = Scene::new(coin, Surface::new(0.5, 0.3).unwrap(), 9.81).unwrap();
        for flight in Flight::ALL {
            let mut tosser = Tosser::new(&scene, &Settings { flight, ..brief() });
            for &size in &extremes {
                for launch in [
                    Launch {
                        height_m: size,
                        ..still()
                    },
                    Launch {
                        velocity_m_s: Vector3::new(size, 0.0, -size),
                        ..still()
                    },
                    Launch {
                        spin_rad_s: Vector3::new(size, size, 0.0),
                        ..still()
                    },
                ] {
                    let account = tosser.examine(&launch);
                    assert!(account.steps <= 300);
                    let failed = account.outcome.ended == Ended::Failed;
                    assert_eq!(failed, account.flaw.is_some(), "{launch:?}");
                }
            }
        }
    }
}

fn still() -> Launch {
    Launch {
        height_m: 1.0,
        velocity_m_s: Vector3::zeros(),
        axis: UnitVector3::new_normalize(Vector3::new(0.3, 0.1, 0.8)),
        spin_rad_s: Vector3::new(1.0, 2.0, 3.0),
    }
}

/// A step in which a coin falls through the plane whole: told, not classified.
#[test]
fn a_coin_that_tunnels_is_not_classified() {
    let scene = scene(1.0, 0.5, 0.3);
    let settings = Settings {
        step_s: 0.05,
        flight: Flight::Off,
        ..quick()
    };
    let mut tosser = Tosser::new(&scene, &settings);
    let accounts =
        (0..50).map(|toss| tosser.examine(&preset_launch(Preset::Clean, &scene, 31, toss)));
    let tunnelled = accounts.filter(|a| a.flaw == Some(Flaw::Tunnelled)).count();
    assert!(tunnelled > 25, "{tunnelled}");
}

#[test]
fn limits_are_kept() {
    let scene = scene(1.0, 0.9, 0.3);
    let launch = preset_launch(Preset::Clean, &scene, 32, 0);
    let mut few = Tosser::new(
        &scene,
        &Settings {
            max_steps: 3,
            ..quick()
        },
    );
    let account = few.examine(&launch);
    assert_eq!(
        (account.outcome.ended, account.steps),
        (Ended::ImpactLimit, 3)
    );
    let mut short = Tosser::new(
        &scene,
        &Settings {
            time_limit: 3.0,
            ..quick()
        },
    );
    assert_eq!(short.toss(&launch).ended, Ended::TimeLimit);
    let mut adhesive = scene;
    adhesive.surface = scene
        .surface
        .with_landing(Landing::Adhesive)
        .expect("a level surface");
    let mut short = Tosser::new(
        &adhesive,
        &Settings {
            time_limit: 3.0,
            ..quick()
        },
    );
    assert_eq!(short.toss(&launch).ended, Ended::TimeLimit);
}

#[test]
fn settings_out_of_range_are_refused() {
    let good = Settings::default();
    for bad in [0.0, -1.0, 101.0, f64::NAN, f64::INFINITY] {
        let settings = Settings {
            step_s: bad,
            ..good
        };
        assert!(
            matches!(settings.validate(), Err(SettingsError::OutOfRange(step)) if step.name == "step_s"),
            "{bad}"
        );
    }
    for bad in [0, 1001] {
        assert!(
            Settings {
                substeps: bad,
                ..good
            }
            .validate()
            .is_err()
        );
    }
    for bad in [0, 1001] {
        assert!(
            Settings {
                tosses_at_once: bad,
                ..good
            }
            .validate()
            .is_err()
        );
    }
    for bad in [0.0, 1.1, f64::NAN] {
        assert!(
            Settings {
                prediction: bad,
                ..good
            }
            .validate()
            .is_err()
        );
    }
    for bad in [0.0, -1.0, f64::NAN] {
        assert!(
            Settings {
                max_gain: bad,
                ..good
            }
            .validate()
            .is_err()
        );
        assert!(
            Settings {
                time_limit: bad,
                ..good
            }
            .validate()
            .is_err()
        );
    }
    assert!(
        Settings {
            max_steps: 0,
            ..good
        }
        .validate()
        .is_err()
    );
}

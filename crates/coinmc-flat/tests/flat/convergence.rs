//! The defaults are converged: finer settings do not change P(side).

use crate::common::engine_with;
use coinmc_core::{Engine, Face, Preset};
use coinmc_flat::Settings;
use coinmc_testkit::{preset_launch, scene};

const TOSSES: u64 = 30_000;

/// Paired difference of P(side) and its standard error. The allowed difference is 0.0005 plus 4
/// standard errors: tosses are chaotic, so those that change at all change at random (false alarms:
/// 6e-5 per scene).
fn check(restitution: f64, finer: Settings) {
    for ratio in [0.25, 1.0, 2.0] {
        let scene = scene(ratio, restitution, 0.3);
        let (coarse, fine) = (
            engine_with(&scene, Settings::default()),
            engine_with(&scene, finer),
        );
        let (mut up, mut down) = (0_u32, 0_u32);
        for toss in 0..TOSSES {
            let launch = preset_launch(Preset::CleanFlat, &scene, 100, toss);
            let side = |engine: &coinmc_flat::FlatEngine<_>| {
                engine.toss(&mut (), &launch, &mut ()).face() == Some(Face::Side)
            };
            match (side(&coarse), side(&fine)) {
                (true, false) => up += 1,
                (false, true) => down += 1,
                _ => {}
            }
        }
        let n = TOSSES as f64;
        let difference = (f64::from(up) - f64::from(down)) / n;
        let error = f64::from(up + down).sqrt() / n;
        println!("e {restitution} ratio {ratio}: {difference:.5} ± {error:.5}");
        assert!(
            difference.abs() <= 0.0005 + 4.0 * error,
            "e {restitution} ratio {ratio}: {difference} ± {error}"
        );
    }
}

#[test]
fn zeno_is_converged() {
    let finer = Settings {
        zeno: 0.001,
        ..Settings::default()
    };
    for restitution in [0.0, 0.3, 0.5] {
        check(restitution, finer);
    }
}

#[test]
fn tolerance_is_converged() {
    let finer = Settings {
        tolerance: 1e-10,
        ..Settings::default()
    };
    for restitution in [0.0, 0.3, 0.5] {
        check(restitution, finer);
    }
}

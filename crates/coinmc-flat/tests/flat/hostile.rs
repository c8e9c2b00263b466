//! Every launch, however extreme, ends in bounded time, without a panic and under the right count.

use crate::common::{Start, engine, engine_with};
use coinmc_core::{Ended, Engine, Launch};
use coinmc_flat::Settings;
use coinmc_testkit::{Dice, is_finite, replace_two, scene, within_two_minutes};
use nalgebra::{UnitVector3, Vector3};

fn extreme(dice: &mut Dice) -> Launch {
    let [height_m, vx, vz, spin] = replace_two(dice);
    let quarter = f64::from(dice.pick(&[0_u8, 1, 2, 3])) * std::f64::consts::FRAC_PI_2;
    let tilt = quarter + dice.pick(&[0.0, 0.0, 1e-17, 0.3, std::f64::consts::FRAC_PI_4]);
    let (sin, cos) = libm::sincos(tilt);
    Launch {
        height_m,
        velocity_m_s: Vector3::new(vx, 0.0, vz),
        axis: UnitVector3::new_unchecked(Vector3::new(sin, 0.0, cos)),
        spin_rad_s: Vector3::new(0.0, spin, 0.0),
    }
}

#[test]
fn extreme_launches_end_and_launches_that_are_not_finite_fail() {
    within_two_minutes(|| {
        let settings = Settings {
            max_impacts: 1000,
            ..Settings::default()
        };
        let mut ends = [0_u32; 4];
        for trial in 0..60_000 {
            let mut dice = Dice::new(120, trial);
            let ratio = dice.pick(&[1e-6, 0.01, 1.0, 2.0, 100.0, 1e6]);
            let restitution = dice.pick(&[0.0, 0.5, 0.99, 1.0]);
            let friction = dice.pick(&[0.0, 0.3, 2.0, 10.0, 1e4, f64::MAX]);
            let engine = engine_with(&scene(ratio, restitution, friction), settings);
            let launch = extreme(&mut dice);
            let outcome = engine.toss(&mut (), &launch, &mut ());
            let end = match outcome.ended {
                Ended::Decided(_) => 0,
                Ended::TimeLimit | Ended::NeverSettles | Ended::Left => 1,
                Ended::ImpactLimit => 2,
                Ended::Failed => 3,
            };
            ends[end] += 1;
            if !is_finite(&launch) {
                assert_eq!(outcome.ended, Ended::Failed, "{trial}: {launch:?}");
            }
            assert!(outcome.impacts <= settings.max_impacts, "{trial}");
        }
        // the trials reach every count except that of the balanced coin
        assert!(ends[0] > 1000 && ends[2] > 0 && ends[3] > 1000, "{ends:?}");
    });
}

/// An axis that is NaN has no face.
#[test]
fn an_axis_of_nan_fails() {
    for (height_m, restitution) in [(0.0, 0.5), (0.005, 0.5), (1.0, 0.5), (1.0, 0.0)] {
        let launch = Launch {
            height_m,
            velocity_m_s: Vector3::zeros(),
            axis: UnitVector3::new_unchecked(Vector3::new(f64::NAN, 0.0, f64::NAN)),
            spin_rad_s: Vector3::zeros(),
        };
        let outcome = engine(&scene(1.0, restitution, 0.3)).toss(&mut (), &launch, &mut ());
        assert_eq!(outcome.ended, Ended::Failed, "from {height_m} m");
    }
}

/// Very large friction makes the edge of the cone ill-conditioned, but not the toss.
#[test]
fn tosses_with_very_large_friction_end() {
    within_two_minutes(|| {
        for friction in [1e2, 1e3, 1e4, 1e6, 1e10, 1e100] {
            for (ratio, restitution) in [(0.1, 0.0), (1.0, 0.0), (1.0, 0.5), (3.0, 0.5)] {
                let scene = scene(ratio, restitution, friction);
                let engine = engine(&scene);
                for toss in 0..1000 {
                    let launch = Start::lively(&mut Dice::new(121, toss)).launch(&scene);
                    let outcome = engine.toss(&mut (), &launch, &mut ());
                    assert!(
                        outcome.face().is_some(),
                        "μ {friction:e}, ratio {ratio}, e {restitution}, toss {toss}: {outcome:?}"
                    );
                }
            }
        }
    });
}

/// Launches from high up, very fast, or inside the surface (these are lifted until they touch) are
/// decided.
#[test]
fn high_fast_and_sunken_launches_are_decided() {
    let scene = scene(1.0, 0.5, 0.3);
    let engine = engine(&scene);
    for trial in 0..2000 {
        let mut dice = Dice::new(122, trial);
        let mut launch = Start::lively(&mut dice).launch(&scene);
        match trial % 4 {
            0 => launch.height_m = 1e4,
            1 => launch.height_m = dice.pick(&[0.0, -0.01, -1e6, 0.004]),
            2 => launch.spin_rad_s.y = dice.scale(1e3, 1e6),
            _ => launch.velocity_m_s.z = -dice.scale(1.0, 1e4),
        }
        let outcome = engine.toss(&mut (), &launch, &mut ());
        assert!(outcome.face().is_some(), "{trial}: {outcome:?} {launch:?}");
    }
}

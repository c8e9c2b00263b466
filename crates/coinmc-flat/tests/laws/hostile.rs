//! Invalid settings are rejected; tosses with extreme launches and stiffnesses end.

use crate::common::{impact, line, materials, settings, touch};
use coinmc_core::{Engine, Scene};
use coinmc_flat::{GaekSukhov, HalfSine, Law, Lever, LineContact, Materials, PulseTime, Settings};
use coinmc_testkit::{Dice, scene};
use std::f64::consts::{FRAC_PI_2, PI};

#[test]
fn quantities_out_of_range_are_rejected() {
    let good = materials(1e9);
    let line = |materials| {
        Law::LineContact(LineContact {
            materials,
            tangential: 0.8,
        })
    };
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let laws = [
            Law::GaekSukhov(GaekSukhov {
                eta_n_s: if bad == 0.0 { -1.0 } else { bad },
                lever: Lever::Height,
            }),
            Law::HalfSine(HalfSine {
                time: PulseTime::Given(bad),
                peak_n: None,
            }),
            Law::HalfSine(HalfSine {
                time: PulseTime::Given(1e-3),
                peak_n: Some(bad),
            }),
            line(Materials {
                coin_young_pa: bad,
                ..good
            }),
            line(Materials {
                surface_young_pa: bad,
                ..good
            }),
            line(Materials {
                length_m: bad,
                ..good
            }),
            line(Materials {
                coin_poisson: 0.6 + bad.abs(),
                ..good
            }),
            Law::LineContact(LineContact {
                materials: good,
                tangential: bad,
            }),
        ];
        for law in laws {
            let refused = Settings {
                law,
                ..Settings::default()
            }
            .validate();
            let message = refused.expect_err("refused").to_string();
            assert!(message.contains("must be"), "{message}");
        }
    }
}

fn finite(scene: &Scene, found: &coinmc_flat::SingleImpact) -> bool {
    found.after.energy_j_kg(scene).is_finite() && found.after.time_s.is_finite()
}

/// E from 1e5 to 1e12 Pa, speeds from 1e-6 to 1e3 m/s, every tilt, including exactly flat, almost
/// flat and with the centre over the corner.
#[test]
fn every_impact_has_a_finite_result() {
    let mut given_up = 0;
    let mut most_steps = 0;
    for trial in 0..3000 {
        let mut dice = Dice::new(240, trial);
        let scene = scene(
            dice.scale(0.05, 20.0),
            dice.pick(&[0.01, 0.3, 0.7, 1.0]),
            dice.pick(&[0.0, 0.1, 0.5, 10.0]),
        );
        let over = libm::atan2(2.0, scene.coin.ratio());
        let flat = f64::from(dice.pick(&[0_u8, 1, 2, 3])) * FRAC_PI_2;
        let near = dice.pick(&[-1.0, 1.0]) * dice.scale(1e-16, 1e-2);
        let any = dice.between(-PI, PI);
        let theta = dice.pick(&[flat, flat + near, over, over + near, -over, any, any]);
        let speed = dice.scale(1e-6, 1e3);
        let slow = dice.pick(&[0.0, 1e-3, 1.0, 1.0]);
        let start = touch(
            theta,
            dice.between(-1.0, 1.0) * speed,
            -speed * slow,
            dice.between(-1.0, 1.0) * speed / 0.01,
        );
        let found = impact(&scene, line(dice.scale(1e5, 1e12)), 1e-6, &start);
        assert!(finite(&scene, &found), "{trial}: {found:?}");
        let before = found.before.energy_j_kg(&scene);
        assert!(
            found.after.energy_j_kg(&scene) <= before * (1.0 + 1e-13),
            "{trial} {found:?}"
        );
        given_up += found.breaks.unresolved;
        most_steps = most_steps.max(found.steps);
    }
    println!("given up {given_up}, most steps {most_steps}");
    assert!(given_up < 30, "{given_up}");
}

/// Whole tosses on surfaces from rubber foam to diamond.
#[test]
fn tosses_on_soft_and_hard_surfaces_end() {
    for young in [1e4, 1e6, 1e9, 1e13] {
        for (e, friction) in [(0.1, 0.3), (0.5, 0.0), (0.5, 2.0), (0.9, 0.3)] {
            let scene = scene(1.1, e, friction);
            let engine = settings(line(young), 1e-4).engine(&scene).unwrap();
            for toss in 0..20 {
                let mut dice = Dice::new(241, toss);
                let mut launch = touch(dice.between(-PI, PI), 0.2, -0.5, dice.between(-30.0, 30.0));
                launch.height_m = 0.1;
                let outcome = engine.toss(&mut (), &launch, &mut ());
                assert!(
                    outcome.face().is_some(),
                    "{young:e} {e} {toss}: {outcome:?}"
                );
            }
        }
    }
}

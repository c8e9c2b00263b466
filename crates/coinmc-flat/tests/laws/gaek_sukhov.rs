//! Gaek & Sukhov's law compared with its formulas in SI units.

use crate::common::{engine, gaek_sukhov, impact, touch};
use coinmc_core::Engine;
use coinmc_flat::{Lever, Settings, SettingsError, SingleImpact};
use coinmc_testkit::{Dice, scene};
use std::f64::consts::FRAC_PI_2;

const MASS_KG: f64 = 0.01;

/// k m g h₁ + I ω₁²/2 = m g h₃ + I ω₂²/2 and Δω = η·lever/I, tilt below and beyond 90°.
#[test]
fn single_impacts_follow_the_published_formulas() {
    let (mut followed, mut broken) = (0, 0);
    for trial in 0..4000 {
        let mut dice = Dice::new(200, trial);
        let ratio = dice.scale(0.1, 5.0);
        let e = dice.between(0.0, 1.0);
        let scene = scene(ratio, e, 0.0);
        let lever = dice.pick(&Lever::ALL);
        let eta = dice.scale(1e-4, 1e-2);
        // tilt of the face, with u to the right of the vertical: the lever turns the coin back
        let tilt = dice.between(0.01, FRAC_PI_2 - 0.01);
        let (vz, spin) = (-dice.between(0.5, 4.0), dice.between(-60.0, 60.0));
        let found = impact(
            &scene,
            gaek_sukhov(eta, lever),
            1e-6,
            &touch(tilt, 0.3, vz, spin),
        );
        let (radius, height) = (0.01, 0.01 * ratio);
        let inertia = MASS_KG * (3.0 * radius * radius + height * height) / 12.0;
        let (sin, cos) = libm::sincos(tilt);
        let corner = radius * cos - height / 2.0 * sin;
        let arm = match lever {
            Lever::Height => height * cos,
            Lever::Diameter => 2.0 * radius * cos,
            Lever::Corner => corner,
        };
        let turned = spin - eta * arm / inertia;
        let weight = MASS_KG * 9.81;
        let (h1, k) = (vz * vz / 2.0 / 9.81, e * e);
        let h3 = (k * weight * h1 + inertia * (spin * spin - turned * turned) / 2.0) / weight;
        // the corner rises: v_z − ω x_c >= 0
        let leaves = h3 >= 0.0 && (2.0 * 9.81 * h3).sqrt() - turned * corner >= 0.0;
        let breaks = found.breaks;
        assert_eq!(breaks.negative_heights, u32::from(h3 < 0.0), "{trial}");
        assert_eq!(breaks.sinkings, u32::from(h3 >= 0.0 && !leaves), "{trial}");
        let wrong = lever != Lever::Corner && corner < 0.0;
        assert_eq!(breaks.wrong_levers, u32::from(wrong), "{trial}");
        let gains = inertia * (turned * turned - spin * spin) / 2.0 > weight * h1;
        assert_eq!(breaks.energy_gains, u32::from(gains), "{trial}");
        if leaves {
            followed += 1;
            assert!((found.after.spin_rad_s.y - turned).abs() < 1e-9 * turned.abs().max(1.0));
            let rise = (2.0 * 9.81 * h3).sqrt();
            // a square root at zero loses half the digits
            assert!((found.after.velocity_m_s.z - rise).abs() < 1e-7, "{trial}");
            assert_eq!(found.after.velocity_m_s.x, found.before.velocity_m_s.x);
        } else {
            broken += 1;
            let energy = |state: &coinmc_core::State| state.energy_j_kg(&scene);
            assert!(energy(&found.after) <= energy(&found.before) * (1.0 + 1e-14));
        }
    }
    assert!(followed > 1000 && broken > 500, "{followed} {broken}");
}

/// The fallback is the frictionless impact with e = √k.
#[test]
fn the_fallback_is_the_frictionless_impact() {
    let scene = scene(1.0, 0.6, 0.0);
    let start = touch(0.4, 0.2, -1.0, 5.0);
    let broken = impact(&scene, gaek_sukhov(0.5, Lever::Height), 1e-6, &start);
    assert_eq!(broken.breaks.negative_heights, 1);
    let newton = SingleImpact::new(&scene, &Settings::default(), &start).unwrap();
    assert_eq!(broken.after, newton.after);
}

/// Without the impulse η the coin rebounds to k times its height.
#[test]
fn without_impulse_the_coin_rises_to_k_times_its_height() {
    for lever in Lever::ALL {
        let found = impact(
            &scene(1.0, 0.7, 0.0),
            gaek_sukhov(0.0, lever),
            1e-6,
            &touch(0.3, 0.0, -2.0, 0.0),
        );
        assert!((found.after.velocity_m_s.z - 1.4).abs() < 1e-12);
        assert_eq!(found.after.spin_rad_s.y, 0.0);
    }
}

/// A constant η does not depend on the fall, yet every toss ends.
#[test]
fn every_toss_ends_for_any_eta() {
    for (eta, e) in [
        (1e-5, 0.3),
        (1e-3, 0.7),
        (1e-1, 0.9),
        (1e3, 0.5),
        (1e-3, 0.0),
    ] {
        for lever in Lever::ALL {
            let scene = scene(1.3, e, 0.0);
            let engine = engine(&scene, gaek_sukhov(eta, lever));
            for toss in 0..200 {
                let mut dice = Dice::new(201, toss);
                let mut launch =
                    touch(dice.between(0.0, 6.0), 0.1, -1.0, dice.between(-30.0, 30.0));
                launch.height_m = 0.3;
                let outcome = engine.toss(&mut (), &launch, &mut ());
                assert!(outcome.face().is_some(), "{eta} {e} {toss}: {outcome:?}");
            }
        }
    }
}

#[test]
fn friction_is_rejected() {
    let with_friction = scene(1.0, 0.5, 0.3);
    let settings = Settings {
        law: gaek_sukhov(1e-3, Lever::Height),
        ..Settings::default()
    };
    let error = settings.engine(&with_friction).err();
    assert_eq!(error, Some(SettingsError::Friction(0.3)));
    assert!(settings.engine(&scene(1.0, 0.5, 0.0)).is_ok());
}

//! The line contact resolved in time: limits with known results, energy, accuracy, the rigid limit.

use crate::common::{impact, line, materials, settings, touch};
use coinmc_core::{Launch, State};
use coinmc_flat::{Law, LineContact, SingleImpact};
use coinmc_testkit::{Dice, scene};
use std::f64::consts::{FRAC_PI_2, PI};

fn distance(a: &State, b: &State) -> f64 {
    let velocity = (a.velocity_m_s - b.velocity_m_s).norm();
    velocity.max((a.spin_rad_s.y - b.spin_rad_s.y).abs() * 0.01)
}

/// A contact that slides in one direction throughout: too fast for friction to stop it.
fn sliding(trial: u64) -> (coinmc_core::Scene, Launch) {
    let mut dice = Dice::new(220, trial);
    let friction = dice.pick(&[0.0, 0.1, 0.2]);
    let scene = scene(dice.scale(0.5, 2.0), dice.between(0.2, 1.0), friction);
    let theta = dice.between(0.3, 1.3);
    let vx = dice.pick(&[-1.0, 1.0]) * dice.between(8.0, 10.0);
    (
        scene,
        touch(theta, vx, -dice.between(1.0, 2.0), dice.between(-5.0, 5.0)),
    )
}

/// All laws agree for sliding in one direction: the difference to Moreau's law falls with the
/// duration of the contact, as K^(−9/19). A factor of 10⁴ in E changes it by 78.5.
#[test]
fn sliding_impacts_converge_to_moreau_s_law_with_the_duration() {
    for trial in 0..100 {
        let (scene, start) = sliding(trial);
        let rigid = impact(&scene, Law::Moreau, 1e-9, &start).after;
        let [soft, hard] = [1e10, 1e14].map(|young| {
            let found = impact(&scene, line(young), 1e-10, &start);
            distance(&found.after, &rigid)
        });
        let order = libm::log(soft / hard) / libm::log(1e4);
        assert!(
            (order - 9.0 / 19.0).abs() < 0.03,
            "{trial}: {order} ({soft} {hard})"
        );
        assert!(hard < 1e-3, "{trial}");
    }
}

/// A hard, frictionless impact of a corner under the centre: u⁺ = −e u⁻, and the duration of the
/// closed form (e = 1).
#[test]
fn a_corner_under_the_centre_rebounds_with_e() {
    let start = touch(PI / 4.0, 0.0, -2.0, 0.0);
    for e in [0.05, 0.3, 0.7, 1.0] {
        let found = impact(&scene(2.0, e, 0.0), line(1e13), 1e-11, &start);
        // gravity changes the velocity by g τ, about 1e-5 m/s
        assert!((found.after.velocity_m_s.z - 2.0 * e).abs() < 1e-4, "{e}");
    }
    let elastic = impact(&scene(2.0, 1.0, 0.0), line(1e13), 1e-11, &start);
    let stiffness = materials(1e13).stiffness();
    let depth = libm::pow(19.0 / 18.0 * 0.01 * 4.0 / stiffness, 9.0 / 19.0);
    let expected = 3.090_487_848_387_577_5 * depth / 2.0;
    assert!((elastic.after.time_s / expected - 1.0).abs() < 1e-5);
    let force = stiffness * libm::pow(depth, 10.0 / 9.0);
    // the step with the largest force lies a little beside the peak
    assert!((elastic.peak_force_n / force - 1.0).abs() < 1e-2);
}

/// The imbalance of the energy is the error of the integration. In the duration of one impact it
/// may drift by the tolerance times the kinetic energy plus its normal part, which is no larger. A
/// step is at most a sixth of that duration, so the drift is below tolerance·energy·steps/3 for
/// every impact. These impacts last a few durations: measured 1.3 tolerances.
#[test]
fn energy_balances_to_the_tolerance_and_is_never_gained() {
    for tolerance in [1e-6, 1e-9] {
        let mut worst: f64 = 0.0;
        for trial in 0..600 {
            let mut dice = Dice::new(221, trial);
            let scene = scene(
                dice.scale(0.1, 10.0),
                dice.pick(&[0.05, 0.3, 0.7, 1.0]),
                dice.pick(&[0.0, 0.1, 0.5, 2.0]),
            );
            let start = touch(
                dice.between(-PI, PI),
                dice.between(-3.0, 3.0),
                -dice.between(0.5, 4.0),
                dice.between(-50.0, 50.0),
            );
            let found = impact(&scene, line(dice.scale(1e8, 1e12)), tolerance, &start);
            assert_eq!(found.breaks.unresolved, 0, "{trial}");
            let energy = |state: &State| state.energy_j_kg(&scene) * 0.01;
            let before = energy(&found.before);
            let imbalance = found.imbalance_j.abs() / before;
            assert!(
                imbalance <= (tolerance / 3.0 + 1e-14) * f64::from(found.steps),
                "{trial} {found:?}"
            );
            worst = worst.max(imbalance);
            assert!(
                found.stays || found.gain_j <= 3.0 * tolerance * before,
                "{trial} {found:?}"
            );
            assert!(energy(&found.after) <= before * (1.0 + 1e-14), "{trial}");
        }
        println!("{tolerance}: {worst}");
        assert!(worst < 3.0 * tolerance, "{tolerance}: {worst}");
    }
}

/// The error of the state falls with the tolerance, through all changes of grip.
#[test]
fn the_error_of_the_state_falls_with_the_tolerance() {
    for trial in 0..100 {
        let mut dice = Dice::new(222, trial);
        let scene = scene(
            dice.scale(0.5, 2.0),
            dice.between(0.2, 1.0),
            dice.pick(&[0.1, 0.3, 1.0]),
        );
        let start = touch(
            dice.between(0.1, 1.5),
            dice.between(-1.0, 1.0),
            -dice.between(1.0, 3.0),
            dice.between(-20.0, 20.0),
        );
        let exact = impact(&scene, line(3e9), 1e-12, &start).after;
        for tolerance in [1e-4, 1e-6, 1e-8] {
            let found = impact(&scene, line(3e9), tolerance, &start).after;
            let error = distance(&found, &exact);
            assert!(error < 300.0 * tolerance, "{trial}: {tolerance} {error}");
        }
    }
}

/// A coin that lands flat presses on both corners equally: it rebounds without turning.
#[test]
fn a_flat_landing_rebounds_without_turning() {
    for theta in [0.0, FRAC_PI_2, PI, -FRAC_PI_2] {
        let found = impact(
            &scene(1.0, 0.5, 0.3),
            line(1e10),
            1e-9,
            &touch(theta, 0.0, -1.0, 0.0),
        );
        assert!(found.after.spin_rad_s.y.abs() < 1e-9, "{theta}");
        assert!((found.after.velocity_m_s.z - 0.5).abs() < 1e-2, "{theta}");
    }
}

/// A coin set down gently stays: it has too little energy to rise against its weight.
#[test]
fn a_gentle_touch_stays() {
    let found = impact(
        &scene(1.0, 0.5, 0.3),
        line(1e7),
        1e-6,
        &touch(0.3, 0.0, -1e-4, 0.0),
    );
    assert!(found.stays);
}

/// A soft coin that lies on both corners and trembles has too little energy to leave as a whole,
/// although neither corner is bound separately; this includes rocking without losses.
#[test]
fn a_coin_that_lies_on_both_corners_stays() {
    for (ratio, restitution, friction, spin) in [
        (0.17, 0.3, 0.1, 0.8),
        (0.14, 0.3, 0.0, 1e-4),
        (0.1, 0.01, 2.0, 0.02),
        (0.2, 1.0, 0.5, 1e-4),
    ] {
        let found = impact(
            &scene(ratio, restitution, friction),
            line(1e5),
            1e-6,
            &touch(PI, 1e-3, -1e-3, spin),
        );
        assert!(found.stays && found.breaks.unresolved == 0, "{found:?}");
        assert!(found.steps < 3000, "{found:?}");
    }
}

/// A corner that comes down fast after another has grazed the surface is resolved on its own scale.
#[test]
fn a_graze_before_a_hard_impact_does_not_add_steps() {
    let scene = scene(6.5, 0.01, 10.0);
    let start = touch(1.5 * PI, -40.0, -50.0, 4000.0);
    let found = impact(&scene, line(1e7), 1e-6, &start);
    assert_eq!(found.breaks.unresolved, 0);
    assert!(found.steps < 3000, "{found:?}");
}

/// Both stiffnesses of like bodies are the same where ν = 0, and two to three where nothing is compressible
/// (Mindlin 1949).
#[test]
fn the_tangential_stiffness_of_like_bodies_is_mindlin_s() {
    for (poisson, ratio) in [(0.0, 1.0), (0.2, 8.0 / 9.0), (0.5, 2.0 / 3.0)] {
        assert!((LineContact::mindlin(poisson) - ratio).abs() < 1e-15);
    }
}

/// Tangential stiffness changes the result where the corner sticks; with every stiffness the impact
/// loses energy.
#[test]
fn tangential_stiffness_matters_for_sticking_corners() {
    let scene = scene(1.0, 0.8, 1.0);
    let start = touch(0.6, 0.5, -2.0, 0.0);
    let [mindlin, stiff] = [LineContact::mindlin(0.3), 100.0].map(|tangential| {
        let law = Law::LineContact(LineContact {
            materials: materials(1e12),
            tangential,
        });
        SingleImpact::new(&scene, &settings(law, 1e-9), &start).unwrap()
    });
    assert!(distance(&mindlin.after, &stiff.after) > 0.05);
    for found in [mindlin, stiff] {
        assert!(found.after.energy_j_kg(&scene) < found.before.energy_j_kg(&scene));
    }
}

/// A corner under the centre that stops sliding is held by a spring as stretched as friction had it, which
/// pulls it back: it leaves backwards, like a ball of rubber, but slower than it came. (Without that stretch
/// nothing would pull, and it would leave without slip.)
#[test]
fn a_corner_that_stops_sliding_springs_back() {
    let scene = scene(2.0, 0.8, 0.5);
    // from the centre to the corner, H/R = 2
    let lever = 0.01 * std::f64::consts::SQRT_2;
    let slip = |vx: f64| {
        let start = touch(PI / 4.0, vx, -2.0, 0.0);
        let after = impact(&scene, line(1e12), 1e-10, &start).after;
        after.velocity_m_s.x - after.spin_rad_s.y * lever
    };
    for vx in [4.0, 5.0, 6.0, 7.0] {
        let (right, left) = (slip(vx), slip(-vx));
        assert!((right + left).abs() < 1e-6, "{vx}: {right} {left}");
        assert!(right < -0.1 * vx && right > -vx, "{vx}: {right}");
    }
    // friction that cannot stop it takes mu (1 + e) of the speed of approach, times K_xx = 1 + r²/k²
    let k = scene.coin.transverse_gyration_m2();
    let taken = 0.5 * 1.8 * 2.0 * (1.0 + lever * lever / k);
    assert!((slip(20.0) - (20.0 - taken)).abs() < 0.02, "{}", slip(20.0));
}

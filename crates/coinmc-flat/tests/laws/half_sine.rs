//! The half sine compared with Moreau's law, its limit for short pulses.

use crate::common::{impact, materials, pulse, touch};
use coinmc_core::State;
use coinmc_flat::{HalfSine, Law, Materials, PulseTime};
use coinmc_testkit::{Dice, scene};
use std::f64::consts::PI;

/// Largest difference of two states in velocity and in spin times R.
fn distance(a: &State, b: &State) -> f64 {
    let velocity = (a.velocity_m_s - b.velocity_m_s).norm();
    velocity.max((a.spin_rad_s.y - b.spin_rad_s.y).abs() * 0.01)
}

/// The error is proportional to τ: a pulse ten times shorter is ten times nearer, within a fifth.
#[test]
fn short_pulses_converge_to_moreau_s_law_with_order_one() {
    for trial in 0..200 {
        let mut dice = Dice::new(210, trial);
        let scene = scene(
            dice.scale(0.3, 3.0),
            dice.between(0.1, 0.9),
            dice.pick(&[0.0, 0.3, 1.0]),
        );
        let start = touch(
            dice.between(0.2, 1.4),
            dice.between(-1.0, 1.0),
            -dice.between(1.5, 3.0),
            dice.between(-20.0, 20.0),
        );
        let rigid = impact(&scene, Law::Moreau, 1e-9, &start);
        let [long, short] = [1e-6, 1e-7].map(|time| {
            let found = impact(&scene, pulse(time), 1e-12, &start);
            assert!((found.after.time_s / time - 1.0).abs() < 1e-12);
            distance(&found.after, &rigid.after)
        });
        assert!(long < 0.05, "{trial}: {long}");
        assert!(
            (long / short / 10.0 - 1.0).abs() < 0.2,
            "{trial}: {long} {short}"
        );
    }
}

/// Impact of a corner under the centre: the coin does not turn, η = (1 + e) m u, N_max = πη/2τ.
#[test]
fn the_peak_force_follows_from_the_impulse() {
    let scene = scene(2.0, 0.5, 0.0);
    let start = touch(PI / 4.0, 0.0, -2.0, 0.0);
    let found = impact(&scene, pulse(1e-4), 1e-12, &start);
    let expected = PI * 1.5 * 2.0 * 0.01 / 2.0 / 1e-4;
    assert!((found.peak_force_n / expected - 1.0).abs() < 1e-9);
    assert!((found.after.velocity_m_s.z - (1.0 - 9.81e-4)).abs() < 1e-9);
}

/// A small given peak gives less rebound, at least none; a large one is reduced to Newton's.
#[test]
fn a_given_peak_is_limited_to_stopping_and_newton() {
    let scene = scene(2.0, 0.5, 0.0);
    let start = touch(PI / 4.0, 0.0, -2.0, 0.0);
    // m u = 0.02 N s stops it, 0.03 N s is Newton's, 0.04 N s elastic
    for (eta, rebound, sinkings, gains) in [
        (0.01, 0.0, 1, 0),
        (0.025, 0.5, 0, 0),
        (0.035, 1.0, 0, 0),
        (0.05, 1.0, 0, 1),
    ] {
        let law = Law::HalfSine(HalfSine {
            time: PulseTime::Given(1e-7),
            peak_n: Some(PI * eta / 2.0 / 1e-7),
        });
        let found = impact(&scene, law, 1e-9, &start);
        assert!((found.after.velocity_m_s.z - rebound).abs() < 1e-5, "{eta}");
        assert_eq!(
            (found.breaks.sinkings, found.breaks.energy_gains),
            (sinkings, gains)
        );
    }
}

/// τ ~ u^(−1/19): a factor of 10 in speed shortens the pulse by 10^(1/19).
#[test]
fn the_duration_of_a_contact_falls_slowly_with_speed() {
    let scene = scene(2.0, 0.5, 0.0);
    let law = Law::HalfSine(HalfSine {
        time: PulseTime::Contact(materials(3e9)),
        peak_n: None,
    });
    let time = |speed: f64| {
        impact(&scene, law, 1e-9, &touch(0.7, 0.0, -speed, 0.0))
            .after
            .time_s
    };
    let ratio = time(0.2) / time(2.0);
    assert!(
        (ratio - libm::pow(10.0, 1.0 / 19.0)).abs() < 1e-9,
        "{ratio}"
    );
    let soft = Materials {
        length_m: 1e-3,
        ..materials(1e8)
    };
    assert!(soft.stiffness() < materials(3e9).stiffness());
}

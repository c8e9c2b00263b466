//! Keller's bands against a toss simulated until its rim touches the floor.

use crate::random::SplitMix;
use coinmc_analytic::keller::{HeadsBand, bias_bound, half_turns, is_heads, p_heads_in_window};
use std::f64::consts::PI;

const GRAVITY: f64 = 9.81;

/// Whether heads shows when the coin, its centre starting one radius above the floor, first
/// touches.
fn lands_heads(speed: f64, spin: f64, radius: f64) -> bool {
    // At most a hundredth of a radian per step, and at least a thousand steps per flight.
    let step = (0.01 / spin).min(2e-3 * speed / GRAVITY);
    let gap =
        |t: f64| speed * t - 0.5 * GRAVITY * t * t + radius * (1.0 - libm::sin(spin * t).abs());
    let mut t = step;
    while gap(t) > 0.0 {
        t += step;
    }
    libm::cos(spin * t) > 0.0
}

#[test]
fn face_is_that_of_the_simulated_toss_for_any_radius() {
    let mut random = SplitMix(3);
    let (mut heads, mut tested) = (0, 0);
    while tested < 500 {
        let (speed, spin) = (random.uniform(0.5, 4.0), random.uniform(5.0, 120.0));
        let radius = random.uniform(1e-4, 0.05);
        let h = half_turns(speed, spin, GRAVITY);
        // One step turns by 0.01/π half-turns: nearer than that to an edge the step length decides,
        // not the toss.
        if (libm::cos(PI * h)).abs() < 0.02 {
            continue;
        }
        assert_eq!(
            lands_heads(speed, spin, radius),
            is_heads(h),
            "{speed} {spin} {radius}"
        );
        tested += 1;
        heads += u32::from(is_heads(h));
    }
    assert!(
        (100..400).contains(&heads),
        "both faces must occur: {heads}"
    );
}

#[test]
fn bands_are_where_the_face_changes() {
    for n in 0..40 {
        let band = HeadsBand::after_turns(n, 2.4, GRAVITY);
        let face = |spin: f64| is_heads(half_turns(2.4, spin, GRAVITY));
        // Edge and half-turns are each rounded a few times; 1e-12 is far beyond both.
        let (inside, outside) = (1.0 - 1e-12, 1.0 + 1e-12);
        assert!(
            face(band.fastest_rad_s * inside) && !face(band.fastest_rad_s * outside),
            "{n}"
        );
        assert!(face(band.slowest_rad_s * outside), "{n}");
        assert_eq!(face(band.slowest_rad_s * inside), n == 0, "{n}");
    }
    assert!(
        HeadsBand::after_turns(0, -1.0, GRAVITY)
            .slowest_rad_s
            .is_nan()
    );
}

#[test]
fn windows_are_averages_of_the_face() {
    let points = 100_000;
    for (from, to) in [
        (0.0, 0.7),
        (-3.2, 1.1),
        (0.4, 0.6),
        (36.9, 40.3),
        (1e3, 1.0123e3),
    ] {
        let middle = |i: u32| from + (to - from) * (f64::from(i) + 0.5) / f64::from(points);
        let heads = (0..points)
            .filter(|&i| libm::cos(PI * middle(i)) > 0.0)
            .count();
        let average = heads as f64 / f64::from(points);
        // Each of at most width + 2 edges may misplace one point.
        let tolerance = (to - from + 2.0) / f64::from(points);
        let p = p_heads_in_window(from, to);
        assert!(
            (p - average).abs() <= tolerance,
            "{from}..{to}: {p} {average}"
        );
    }
}

#[test]
fn bias_bound_holds_and_is_reached() {
    let mut random = SplitMix(4);
    for _ in 0..10_000 {
        let (from, width) = (
            random.uniform(-50.0, 50.0),
            60.0 * random.uniform(1e-2, 1.0).powi(3),
        );
        let p = p_heads_in_window(from, from + width);
        assert!((0.0..=1.0).contains(&p), "{from} {width}: {p}");
        let bias = (p - 0.5).abs();
        // from + width, near 100 at most, is rounded to 7e-15; over the width, 6e-5 at least,
        // 1e-10.
        assert!(bias <= bias_bound(width) + 1e-9, "{from} {width}");
    }
    for turns in 0..20 {
        // Both ends in heads: one more band of heads than of tails.
        let to = 2.0 * f64::from(turns) + 0.5;
        assert!((p_heads_in_window(-0.5, to) - 0.5 - bias_bound(to + 0.5)).abs() < 1e-15);
    }
}

#[test]
fn no_face_is_claimed_outside_the_domain() {
    assert!(half_turns(-1.0, 1.0, GRAVITY).is_nan() && half_turns(1.0, 1.0, -GRAVITY).is_nan());
    // Without gravity the coin never returns.
    let band = HeadsBand::after_turns(1, 2.4, 0.0);
    assert!(half_turns(2.4, 238.6, 0.0).is_nan());
    assert!(band.slowest_rad_s.is_nan() && band.fastest_rad_s.is_nan());
    assert!(!is_heads(f64::INFINITY));
    assert!(p_heads_in_window(1.0, 0.0).is_nan() && p_heads_in_window(0.0, f64::INFINITY).is_nan());
    assert_eq!(
        (p_heads_in_window(0.2, 0.2), p_heads_in_window(1.0, 1.0)),
        (1.0, 0.0)
    );
    assert!(bias_bound(-1.0).is_nan() && bias_bound(f64::INFINITY) == 0.0);
}

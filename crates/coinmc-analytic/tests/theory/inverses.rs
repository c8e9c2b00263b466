//! `fair_ratio` inverts `p_side`, from vanishing targets to the largest below 1.

use coinmc_analytic::precession::{thick, thin};
use coinmc_analytic::{FaceProbabilities, Rule};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

/// Targets by powers of two, 2⁻¹⁰⁰ … ½ … 1 − 2⁻⁵³, and others between.
fn targets() -> impl Iterator<Item = f64> {
    let small = (1..=100).flat_map(|k| [0.5f64.powi(k), 0.77 * 0.5f64.powi(k)]);
    small.chain((2..=53).map(|k| 1.0 - 0.5f64.powi(k)))
}

/// |ln odds(found) − ln odds(target)| in units of 2⁻⁵²: the error of P(side) or of 1 − P(side),
/// whichever is larger, within a factor of two. 1 − target is exact above one half and harmless
/// below.
fn odds_error(found: &FaceProbabilities, target: f64) -> f64 {
    let quotient = (found.side / target) * ((1.0 - target) / found.faces());
    (quotient - 1.0).abs() / f64::EPSILON
}

#[test]
fn every_rule_round_trips() {
    // The last rounding of the ratio counts with the power in which the odds depend on it (1 to 4),
    // plus the roundings of the rule itself (see `accuracy`), twice because two are compared.
    let allowed = [6.0, 6.0, 4.0, 4.0, 12.0, 14.0];
    for (rule, bound) in Rule::ALL.into_iter().zip(allowed) {
        let worst = targets()
            .map(|target| odds_error(&rule.probabilities(rule.fair_ratio(target)), target))
            .fold(0.0, f64::max);
        println!("{rule:16} {worst:.1} units");
        assert!(worst <= bound, "{rule}: {worst} units");
    }
}

#[test]
fn odds_of_the_wells_rise_with_powers_within_a_factor_of_two() {
    // The convergence of the inverse depends on this.
    for rule in [Rule::WellDepthFlat, Rule::WellDepthSolid] {
        for k in -240..=240 {
            let ratio = libm::exp10(f64::from(k) / 20.0);
            let log_odds = |x: f64| {
                let p = rule.probabilities(x);
                libm::log(p.side / p.faces())
            };
            let power = (log_odds(1.001 * ratio) - log_odds(ratio)) / libm::log(1.001);
            // 3 at the thin end, 3 and 4 at the thick one, 2 + √5 at most between; logarithms up to
            // 110 are rounded to 1.4e-14, over 0.001.
            assert!(
                (3.0 - 1e-10..4.24).contains(&power),
                "{rule} {ratio}: {power}"
            );
        }
    }
}

/// Error of the round trip in units of 2⁻⁵², in P(side) or, above one half, in 1 − P(side), over
/// the error that a rounding of the ratio alone would cause: its condition is `x·dP/dx`, taken here
/// as a difference quotient.
fn precessing_round_trip(target: f64, psi: f64) -> f64 {
    let ratio = thick::fair_ratio(target, psi);
    let smaller = |x: f64| {
        let p = thick::probabilities(x, psi);
        if target <= 0.5 { p.side } else { p.faces() }
    };
    let (found, wanted) = (smaller(ratio), target.min(1.0 - target));
    let slope = (smaller(ratio * 1.000_001) - found).abs() / 1e-6;
    (found - wanted).abs() / (wanted + slope) / f64::EPSILON
}

#[test]
fn precessing_coin_round_trips_at_every_angle() {
    let degrees = [
        1.0f64, 20.0, 44.9, 45.1, 50.0, 60.0, 75.0, 89.0, 91.0, 120.0, 134.0, 170.0,
    ];
    let mut worst = 0.0f64;
    for psi in degrees.map(f64::to_radians) {
        let evenly = (1..200).map(|k| f64::from(k) / 200.0);
        for target in evenly.chain((2..=53).map(|k| 1.0 - 0.5f64.powi(k))) {
            let error = precessing_round_trip(target, psi);
            worst = worst.max(error);
            // A dozen roundings of half a unit, rarely all of one sign.
            assert!(error <= 8.0, "{psi} {target}: {error:.1} units");
        }
    }
    println!("precession       {worst:.1} units");
}

#[test]
fn precessing_coin_round_trips_where_tails_only_just_comes_into_reach() {
    // Within a few units in the last place of π/4, with targets whose square is as small as the
    // distance to it.
    for steps in -8..=8 {
        let psi = FRAC_PI_4 + 0.5 * f64::from(steps) * f64::EPSILON;
        for target in (0..600).map(|k| 0.5 * libm::exp(-0.035 * f64::from(k))) {
            let error = precessing_round_trip(target, psi);
            // As above.
            assert!(error <= 8.0, "{steps} {target}: {error:.1} units");
        }
    }
}

#[test]
fn precessing_coin_round_trips_where_tails_only_just_goes_out_of_reach() {
    // Close to π/2, with targets that leave about as little to the faces.
    for distance in [0.0, 1e-12, 1e-10, 1e-8, 1e-4] {
        for target in (2..=50).map(|k| 1.0 - 0.5f64.powi(k)) {
            let error = precessing_round_trip(target, FRAC_PI_2 - distance);
            // As above.
            assert!(error <= 8.0, "{distance} {target}: {error:.1} units");
        }
    }
}

#[test]
fn precessing_coin_round_trips_for_vanishing_targets_where_tails_is_in_reach() {
    for psi in [0.8, 1.0, 1.3, FRAC_PI_2, 2.0] {
        for target in (20..100).map(|k| 0.5f64.powi(k)) {
            let found = thick::p_side(thick::fair_ratio(target, psi), psi);
            // P is proportional to the ratio here; a dozen roundings both ways, and cos 2ψ at 0.8
            // loses a factor of 50 (|2ψ·tan 2ψ|).
            assert!(
                (found / target - 1.0).abs() < 100.0 * f64::EPSILON,
                "{psi} {target}: {found}"
            );
        }
    }
}

#[test]
fn precessing_coin_starts_to_reach_its_side_at_the_returned_edge() {
    for psi in [0.2, 0.5, FRAC_PI_4 - 1e-3, 2.8] {
        let edge = thick::fair_ratio(0.0, psi);
        // A relative distance of 1e-9 is far outside round-off.
        assert_eq!(thick::p_side(edge * (1.0 - 1e-9), psi), 0.0);
        assert!(thick::p_side(edge * (1.0 + 1e-9), psi) > 0.0);
        assert_eq!(thick::fair_ratio(1.0, psi), f64::INFINITY);
    }
    assert_eq!(thick::fair_ratio(0.0, 1.0), 0.0);
    assert_eq!(thick::fair_ratio(1.0, 1.0), f64::INFINITY);
    // A coin that never tips, heads along its angular momentum or against it.
    assert!(thick::fair_ratio(0.5, 0.0).is_nan() && thick::fair_ratio(0.5, PI).is_nan());
}

#[test]
fn angle_of_the_thin_coin_round_trips() {
    for bias in (2..=50)
        .map(|k| 0.5f64.powi(k))
        .chain([0.008, 0.3, 0.49, 0.499_999])
    {
        let found = thin::p_same_side(thin::psi_rad(0.5 + bias));
        // P is flat at ½ (no loss) and as steep as 1/sqrt(2(ψ − π/4)) near 1: ψ's rounding, 1e-16,
        // times 1/(π·(½ − bias)), 3e5 at most.
        let tolerance = 2e-16 * (2.0 + 1.0 / (0.5 - bias));
        assert!((found - 0.5 - bias).abs() <= tolerance, "{bias}: {found}");
    }
    assert_eq!(
        (thin::psi_rad(0.5), thin::psi_rad(1.0)),
        (FRAC_PI_2, FRAC_PI_4)
    );
    assert!(thin::psi_rad(1.1).is_nan() && thin::psi_rad(f64::NAN).is_nan());
}

//! The rules by name: published fair coins, limits, domain, parsing.

use coinmc_analytic::Rule;
use std::f64::consts::{FRAC_1_SQRT_2, PI};

#[test]
fn fair_coins_are_the_published_ones() {
    let fair = [1.1547, FRAC_1_SQRT_2, 0.5, 1.0, 1.6570, 1.3545];
    for (rule, expected) in Rule::ALL.into_iter().zip(fair) {
        // Published to four decimals.
        assert!(
            (rule.fair_ratio(1.0 / 3.0) - expected).abs() < 5.001e-5,
            "{rule}"
        );
    }
}

#[test]
fn thin_coins_follow_the_leading_power() {
    let thin: [(f64, i32); 6] = [
        (1.0 / PI, 1),
        (0.5, 1),
        (1.0, 1),
        (0.5, 1),
        (1.0 / (8.0 * PI), 3),
        (1.0 / 16.0, 3),
    ];
    for (rule, (factor, power)) in Rule::ALL.into_iter().zip(thin) {
        for ratio in [1e-12f64, 1e-9, 1e-6] {
            // The next term is smaller by the ratio times a factor below 2.
            let expected = factor * ratio.powi(power);
            assert!(
                (rule.p_side(ratio) / expected - 1.0).abs() < 2.0 * ratio + 1e-15,
                "{rule}"
            );
        }
    }
}

#[test]
fn the_thinnest_coins_keep_the_leading_power() {
    // Powers of two down to where numbers end, whose halves are exact.
    for ratio in (0..1070).map(|k| 0.5f64.powi(k)).filter(|x| *x < 1e-20) {
        assert_eq!(Rule::Zone.p_side(ratio), 0.5 * ratio);
    }
    // Targets that only a ratio below 1e-20 reaches, where x³/(8π) and x³/16 are exact to rounding.
    for (rule, factor) in [
        (Rule::WellDepthFlat, 8.0 * PI),
        (Rule::WellDepthSolid, 16.0),
    ] {
        for decade in 21..100 {
            let ratio = libm::exp10(-f64::from(decade));
            let found = rule.fair_ratio(ratio * ratio * ratio / factor);
            // Six roundings of the cube, which count a third each, and one of the cube root.
            assert!((found / ratio - 1.0).abs() < 1e-15, "{rule}: {found:e}");
        }
    }
}

#[test]
fn thick_coins_follow_the_leading_power() {
    let thick: [(f64, i32); 6] = [
        (4.0 / PI, 1),
        (2.0, 2),
        (1.0, 1),
        (2.0, 1),
        (8.0 / PI, 3),
        (4.0, 4),
    ];
    for (rule, (factor, power)) in Rule::ALL.into_iter().zip(thick) {
        for ratio in [1e6f64, 1e9, 1e12] {
            // The next term is smaller by a factor of at most 4/ratio (the flat wells: 2 + 4/π).
            let expected = factor / ratio.powi(power);
            let faces = rule.probabilities(ratio).faces();
            assert!(
                (faces / expected - 1.0).abs() <= 4.0 / ratio + 1e-15,
                "{rule} {ratio}"
            );
        }
    }
}

#[test]
fn limits_are_values_and_everything_else_is_nan() {
    for rule in Rule::ALL {
        for (ratio, heads, side) in [(0.0, 0.5, 0.0), (-0.0, 0.5, 0.0), (f64::INFINITY, 0.0, 1.0)] {
            let p = rule.probabilities(ratio);
            assert_eq!(
                (p.heads, p.tails, p.side),
                (heads, heads, side),
                "{rule} {ratio}"
            );
        }
        for ratio in [-1e-300, -1.0, f64::NEG_INFINITY, f64::NAN] {
            let p = rule.probabilities(ratio);
            assert!(
                p.heads.is_nan() && p.tails.is_nan() && p.side.is_nan(),
                "{rule} {ratio}"
            );
        }
        assert_eq!(
            (rule.fair_ratio(0.0), rule.fair_ratio(1.0)),
            (0.0, f64::INFINITY),
            "{rule}"
        );
        for target in [-0.1, 1.0 + f64::EPSILON, f64::INFINITY, f64::NAN] {
            assert!(rule.fair_ratio(target).is_nan(), "{rule} {target}");
        }
    }
}

#[test]
fn no_finite_ratio_overflows() {
    for rule in Rule::ALL {
        assert_eq!(rule.p_side(f64::MAX), 1.0, "{rule}");
        assert!(rule.p_side(f64::MIN_POSITIVE) < 1e-300, "{rule}");
        let tiny = rule.fair_ratio(f64::MIN_POSITIVE);
        assert!(tiny > 0.0 && tiny < 1e-100, "{rule}: {tiny}");
    }
}

#[test]
fn names_parse_back_and_descriptions_exist() {
    for rule in Rule::ALL {
        assert_eq!(rule.name().parse(), Ok(rule));
        assert_eq!(format!("{rule:>20}"), format!("{:>20}", rule.name()));
        assert!(!rule.formula().is_empty() && !rule.assumption().is_empty());
        assert!(!rule.source().is_empty());
    }
    let message = "Arc".parse::<Rule>().unwrap_err().to_string();
    assert!(
        Rule::ALL.iter().all(|rule| message.contains(rule.name())),
        "{message}"
    );
}

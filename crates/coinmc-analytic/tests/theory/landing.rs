//! Arc and zone rules from the mechanics of an adhesive landing.

use crate::measure::{intervals, simpson};
use crate::random::{SplitMix, assert_share};
use crate::tipping::{Rest, rest, rest_tilted};
use coinmc_analytic::{arc, zone};
use std::f64::consts::{FRAC_1_SQRT_2, PI, TAU};

const RATIOS: [f64; 8] = [0.02, 0.184, 0.5, FRAC_1_SQRT_2, 1.0, 1.1547, 2.0, 9.0];

#[test]
fn arc_rule_is_the_share_of_landing_angles_that_tip_to_each_face() {
    for ratio in RATIOS {
        let share = |face| {
            let angles = intervals(0.0, TAU, 4096, |theta| rest_tilted(ratio, theta) == face);
            angles.iter().map(|(a, b)| b - a).sum::<f64>() / TAU
        };
        let p = arc::probabilities(ratio);
        // Up to four ends, each with the rounding of an angle below 2π: 4·1e-15/2π, times ten.
        for (face, expected) in [
            (Rest::Heads, p.heads),
            (Rest::Tails, p.tails),
            (Rest::Side, p.side),
        ] {
            assert!(
                (share(face) - expected).abs() < 1e-14,
                "{face:?} at {ratio}: {expected}"
            );
        }
    }
}

#[test]
fn zone_rule_is_the_share_of_the_sphere_that_tips_to_each_face() {
    for ratio in RATIOS {
        let share = |face| {
            intervals(0.0, PI, 4096, |theta| rest_tilted(ratio, theta) == face)
                .into_iter()
                .map(|(a, b)| 0.5 * simpson(a, b, 4000, libm::sin))
                .sum::<f64>()
        };
        let p = zone::probabilities(ratio);
        // Simpson: π⁵/(180·4000⁴) = 7e-15; sums of 4000 rounded terms: 1e-13 at most.
        for (face, expected) in [
            (Rest::Heads, p.heads),
            (Rest::Tails, p.tails),
            (Rest::Side, p.side),
        ] {
            assert!(
                (share(face) - expected).abs() < 1e-13,
                "{face:?} at {ratio}: {expected}"
            );
        }
    }
}

#[test]
fn zone_rule_is_the_share_of_random_orientations() {
    let mut random = SplitMix(1);
    for ratio in RATIOS {
        let p = zone::probabilities(ratio);
        let n = 200_000;
        let outcomes: Vec<Rest> = (0..n).map(|_| rest(ratio, random.direction())).collect();
        for (face, expected) in [
            (Rest::Heads, p.heads),
            (Rest::Tails, p.tails),
            (Rest::Side, p.side),
        ] {
            let hits = outcomes.iter().filter(|outcome| **outcome == face).count();
            assert_share(
                u32::try_from(hits).unwrap(),
                n,
                expected,
                &format!("{face:?} at {ratio}"),
            );
        }
    }
}

/// Area of the zone between the rims cut into `slices` conical frusta.
fn zone_of_frusta(height: f64, radius: f64, slices: u32) -> f64 {
    let l2 = radius * radius + 0.25 * height * height;
    let node = |i: u32| height * (f64::from(i) / f64::from(slices) - 0.5);
    let rim = |z: f64| (l2 - z * z).sqrt();
    (0..slices)
        .map(|i| {
            let (a, b) = (node(i), node(i + 1));
            PI * (rim(a) + rim(b)) * libm::hypot(b - a, rim(b) - rim(a))
        })
        .sum()
}

#[test]
fn zone_area_is_that_of_the_surface_of_revolution() {
    for (height, radius) in [(0.01, 1.0), (1.0, 1.0), (2.0, 0.7), (1.5, 3.0), (3.0, 1.0)] {
        let (coarse, fine) = (
            zone_of_frusta(height, radius, 2000),
            zone_of_frusta(height, radius, 4000),
        );
        // Frusta converge like 1/slices²; one extrapolation leaves terms of 1/slices⁴ < 1e-12.
        let area = fine + (fine - coarse) / 3.0;
        let expected = zone::area_m2(height, radius);
        assert!(
            (area / expected - 1.0).abs() < 1e-10,
            "{height} {radius}: {area} {expected}"
        );
    }
}

#[test]
fn zone_area_over_the_sphere_is_the_zone_rule() {
    for ratio in RATIOS {
        let sphere = 4.0 * PI * (1.0 + 0.25 * ratio * ratio);
        // A handful of roundings.
        assert!((zone::area_m2(ratio, 1.0) / sphere / zone::p_side(ratio) - 1.0).abs() < 1e-15);
    }
    assert!(zone::area_m2(-1.0, 1.0).is_nan() && zone::area_m2(1.0, f64::NAN).is_nan());
}

#[test]
fn published_figures_of_a_nickel() {
    // 1.95 mm high, 21.21 mm wide; published as integers.
    let nickel = 1.95 / (0.5 * 21.21);
    let odds = |p: f64| (1.0 / p).round();
    assert_eq!(odds(arc::p_side(nickel)), 17.0);
    assert_eq!(odds(zone::p_side(nickel)), 11.0);
    assert_eq!(
        odds(coinmc_analytic::well_depth::flat::p_side(nickel)),
        3491.0
    );
}

//! Well-depth rules from the height of the centre as a function of the tilt.

use crate::measure::{intervals, minimum, simpson};
use crate::tipping::{Rest, rest_tilted};
use coinmc_analytic::well_depth::{face_depth, flat, side_depth, solid};
use std::f64::consts::{FRAC_PI_2, PI};

const RATIOS: [f64; 9] = [0.05, 0.184, 0.5, 1.0, 1.3545, 1.657, 2.0, 3.0, 20.0];

/// Height of the centre above the floor at the tilt `theta`: the depth of the lowest corner below
/// it.
fn centre_height(ratio: f64, theta: f64) -> f64 {
    let (sin, cos) = (libm::sin(theta), libm::cos(theta));
    [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)]
        .map(|(across, along)| across * sin + along * 0.5 * ratio * cos)
        .into_iter()
        .fold(f64::NEG_INFINITY, f64::max)
}

/// Depths of a face's well and of the side's, in radii.
fn depths(ratio: f64) -> (f64, f64) {
    let barrier = -minimum(0.0, FRAC_PI_2, |theta| -centre_height(ratio, theta));
    // A small interval about each minimum, with no second one inside.
    let face = minimum(-0.01, 0.01, |theta| centre_height(ratio, theta));
    let side = minimum(FRAC_PI_2 - 0.01, FRAC_PI_2 + 0.01, |theta| {
        centre_height(ratio, theta)
    });
    (barrier - face, barrier - side)
}

/// Tilts from 0 to a half-turn that fall back onto the side.
fn side_tilts(ratio: f64) -> (f64, f64) {
    let found = intervals(0.0, PI, 4096, |theta| {
        rest_tilted(ratio, theta) == Rest::Side
    });
    assert_eq!(found.len(), 1);
    found[0]
}

#[test]
fn depths_are_barrier_minus_minimum() {
    for ratio in RATIOS {
        let (face, side) = depths(ratio);
        // Heights up to l are rounded to l·2e-16, l ≤ 10.1 here.
        assert!((face - face_depth(ratio)).abs() < 1e-14, "{ratio}: {face}");
        assert!((side - side_depth(ratio)).abs() < 1e-14, "{ratio}: {side}");
    }
    assert!(side_depth(-0.1).is_nan() && face_depth(f64::NAN).is_nan());
    assert_eq!(
        (side_depth(f64::INFINITY), face_depth(f64::INFINITY)),
        (f64::INFINITY, 0.0)
    );
}

#[test]
fn flat_rule_weighs_depth_by_angle() {
    for ratio in RATIOS {
        let (face, side) = depths(ratio);
        let (from, to) = side_tilts(ratio);
        let (side, face) = (side * (to - from), face * (PI - (to - from)));
        // The smaller depth, at least 3e-4, carries an absolute error of 1e-14; so does the angle.
        assert!(
            (side / (side + face) / flat::p_side(ratio) - 1.0).abs() < 1e-9,
            "{ratio}"
        );
    }
}

#[test]
fn solid_rule_weighs_depth_by_solid_angle() {
    for ratio in RATIOS {
        let (face, side) = depths(ratio);
        let (from, to) = side_tilts(ratio);
        let cap = 0.5 * simpson(0.0, from, 2000, libm::sin);
        let zone = 0.5 * simpson(from, to, 2000, libm::sin);
        let (side, face) = (side * zone, face * 2.0 * cap);
        // As above; Simpson's π⁵/(180·2000⁴) = 1e-13 against a share of 0.0025 at least.
        assert!(
            (side / (side + face) / solid::p_side(ratio) - 1.0).abs() < 1e-9,
            "{ratio}"
        );
    }
}

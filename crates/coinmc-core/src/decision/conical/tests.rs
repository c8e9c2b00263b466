//! The rule on coins whose faces are not alike, against hand calculations for each of their rims.

use super::*;
use crate::decision::tests::{lying, moving, scene, tossed};
use crate::{Coin, CoinError, Decided};

const FLAT_SINE: f64 = 2e-3;

/// Each lower rim of a scene with this coin.
fn rims(coin: Result<Coin, CoinError>, mu: f64) -> [(Scene, LowerRim); 2] {
    let coin = coin.expect("a good coin");
    let scene = tossed(coin, scene(1.0, mu).surface);
    LowerRim::of(&coin).map(|rim| (scene, rim))
}

/// A thin and a thick coin with a conical edge and loaded ones, on each of their rims.
fn all_rims(mu: f64) -> impl Iterator<Item = (Scene, LowerRim)> {
    let cylinder = |ratio: f64| Coin::cylinder(ratio, 0.01);
    let loaded = |ratio: f64| cylinder(ratio)?.with_centre_of_mass(0.1, None, None);
    let coins = [
        cylinder(1.0).and_then(|it| it.with_draft(10.0)),
        cylinder(1.5).and_then(|it| it.with_draft(-5.0)),
        loaded(0.5),
        loaded(2.0),
    ];
    coins.into_iter().flat_map(move |coin| rims(coin, mu))
}

/// Distance of a rim from the centre: the height of the centre that is above it.
fn distance(body: &Body) -> f64 {
    libm::hypot(body.radius, body.half)
}

/// The energy that it takes to leave a face, over its own rim, and the edge, over the nearer one.
fn barriers(rim: &LowerRim) -> [(f64, Decided, f64); 2] {
    let own = distance(&rim.body);
    let (edge, _) = rim.on_edge();
    [
        (0.1, Decided::Face, own),
        (edge, Decided::Side, own.min(distance(&rim.upper))),
    ]
}

/// A coin that lies still, on its edge at the cosine that the frame of the lower rim gives it.
fn still(rim: &LowerRim, sin: f64) -> DecisionState<f64> {
    let (edge, cos) = rim.on_edge();
    let state = lying(&rim.body, sin);
    if sin == edge {
        let energy = rim.height_on_edge();
        DecisionState {
            energy,
            cos,
            ..state
        }
    } else {
        state
    }
}

/// Whether a toss in this state but for its energy is decided below the limit, and open above it.
fn limited(rule: &DecisionRule, state: DecisionState<f64>, well: Decided, limit: f64) -> bool {
    let decide = |energy: f64| rule.decide(&DecisionState { energy, ..state });
    decide(limit - 1e-4) == well && decide(limit + 1e-4) == Decided::Open
}

#[test]
fn a_face_is_left_over_its_own_rim_and_the_edge_over_the_nearer_one() {
    for (scene, rim) in all_rims(0.3) {
        for tilting in [false, true] {
            let rule = DecisionRule::on_lower_rim(&scene, &rim, tilting, FLAT_SINE);
            for (sin, well, barrier) in barriers(&rim) {
                assert!(limited(&rule, still(&rim, sin), well, barrier), "{rim:?}");
            }
        }
    }
}

/// Sliding and spinning flat, a coin may only be tipped by friction: the moment of the weight, less that of
/// friction, is added up over short steps of the tilt, up to where both are equal. A coin that leans, or is
/// on its edge, may turn all of that motion into tilt.
#[test]
fn friction_lowers_the_barrier_of_the_rim_that_a_coin_slides_on() {
    let mu = 0.3;
    for (scene, rim) in all_rims(mu) {
        let rule = DecisionRule::on_lower_rim(&scene, &rim, true, FLAT_SINE);
        let body = rim.body;
        let equal = libm::atan2(body.radius - mu * body.half, body.half + mu * body.radius);
        let step = equal / 1e4;
        let work: f64 = (0..10_000)
            .map(|i| libm::sincos(step * (f64::from(i) + 0.5)))
            .map(|(s, c)| (body.radius - mu * body.half) * c - (body.half + mu * body.radius) * s)
            .sum::<f64>()
            * step;
        let slides = |sin: f64| DecisionState {
            vx: 3.0,
            vy: -4.0,
            axial: 5.0,
            ..still(&rim, sin)
        };
        let limit = moving(&body, slides(0.0), 0.0).energy + work;
        assert!(
            limited(&rule, slides(0.0), Decided::Face, limit),
            "{rim:?} {work}"
        );
        for (sin, well, barrier) in barriers(&rim) {
            assert!(limited(&rule, slides(sin), well, barrier), "{rim:?}");
        }
    }
}

/// H/R = 7 with the centre of mass off the middle, h = 4.2 R below one face and 2.8 R below the other: with
/// μ = 0.3 friction tips the coin on the rim that is farther below the centre, as 1.26 > 1 > 0.84.
#[test]
fn friction_alone_tips_a_coin_on_the_face_far_below_its_centre() {
    let tall = Coin::cylinder(7.0, 0.01).and_then(|it| it.with_centre_of_mass(0.1, None, None));
    for (scene, rim) in rims(tall, 0.3) {
        let rule = DecisionRule::on_lower_rim(&scene, &rim, true, FLAT_SINE);
        let slides = DecisionState {
            vx: 3.0,
            ..still(&rim, 0.0)
        };
        let decided = rule.decide(&moving(&rim.body, slides, 0.0));
        let is_far = rim.body.half > 3.0 * rim.body.radius;
        assert_eq!(decided == Decided::Open, is_far, "{rim:?}");
    }
}

/// Without friction the horizontal velocity never tilts the coin, nor does the spin about the axis where
/// the coin is flat or on its edge; one that leans may turn it into precession.
#[test]
fn without_friction_sliding_is_left_out_and_spinning_where_it_cannot_tilt() {
    for (scene, rim) in all_rims(0.0) {
        for tilting in [false, true] {
            let rule = DecisionRule::on_lower_rim(&scene, &rim, tilting, FLAT_SINE).in_time_steps();
            let [leans, edge] = barriers(&rim);
            let flat = (0.0, Decided::Face, leans.2);
            for (i, (sin, well, barrier)) in [leans, edge, flat].into_iter().enumerate() {
                let (vx, vy, axial) = (3.0, -4.0, 5.0);
                let spinning = 0.5 * rim.body.ka * axial * axial;
                let left_out = if tilting && i > 0 { spinning } else { 0.0 };
                let limit = barrier + 0.5 * (vx * vx + vy * vy) + left_out;
                let state = DecisionState {
                    vx,
                    vy,
                    axial,
                    ..still(&rim, sin)
                };
                assert!(limited(&rule, state, well, limit), "{rim:?} {sin}");
            }
        }
    }
}

/// Each balance takes D of its rim and the energy of turning, b²/(2k_t), with the component b of L across the
/// axis that L_z = c L_a + s b leaves. At the balance on the lower rim c = h/D and s = R/D; on the upper one
/// the axis points down, c = −h'/D'.
#[test]
fn without_any_friction_each_rim_has_a_balance_of_its_own() {
    for (scene, rim) in all_rims(0.0) {
        let body = rim.body;
        let rule = DecisionRule::on_lower_rim(&scene, &rim, false, FLAT_SINE);
        for (axial, vertical) in [(6.0, 3.0), (-6.0, 3.0), (6.0, -3.0), (0.0, 4.0)] {
            let over = |at: &Body, side: f64| {
                let (sin, cos) = (at.radius / distance(at), side * at.half / distance(at));
                let across = (body.kt * vertical - cos * body.ka * axial) / sin;
                distance(at) + across * across / (2.0 * body.kt)
            };
            let (own, other) = (over(&body, 1.0), over(&rim.upper, -1.0));
            let [(leans, face, _), (edge, side, _)] = barriers(&rim);
            let spinning = 0.5 * body.ka * axial * axial;
            for (sin, well, least) in [(leans, face, own), (edge, side, own.min(other))] {
                let state = DecisionState {
                    axial,
                    vertical,
                    ..still(&rim, sin)
                };
                assert!(
                    limited(&rule, state, well, least + spinning),
                    "{rim:?} {axial}"
                );
            }
        }
    }
}

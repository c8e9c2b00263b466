//! The rule against hand calculations, one for each of its parts.

use super::*;
use crate::{Coin, Surface, TableTilt};

pub(super) fn scene(ratio: f64, mu: f64) -> Scene {
    let coin = Coin::cylinder(ratio, 0.01).expect("a good coin");
    let surface = Surface::new(0.5, mu).expect("a good surface");
    tossed(coin, surface)
}

/// A scene of this coin on this surface.
pub(super) fn tossed(coin: Coin, surface: Surface) -> Scene {
    Scene::new(coin, surface, 9.81).expect("good gravity")
}

/// A coin at rest where it lies on the surface, tilted by the angle with this sine.
pub(super) fn lying(body: &Body, sin: f64) -> DecisionState<f64> {
    let cos = ((1.0 - sin) * (1.0 + sin)).sqrt();
    DecisionState {
        energy: body.half * cos + body.radius * sin,
        sin,
        cos,
        vx: 0.0,
        vy: 0.0,
        axial: 0.0,
        vertical: 0.0,
    }
}

/// The same with the energy of its velocities and of a vertical velocity `rises`.
pub(super) fn moving(body: &Body, state: DecisionState<f64>, rises: f64) -> DecisionState<f64> {
    let speeds = state.vx * state.vx + state.vy * state.vy + rises * rises;
    // near its side and flat, Ω_z is the spin about a diameter or about the axis
    let about = state.sin * state.vertical;
    DecisionState {
        energy: state.energy
            + 0.5 * (speeds + body.ka * state.axial * state.axial + body.kt * about * about),
        ..state
    }
}

#[test]
fn below_the_barrier_the_coin_stays_in_its_well() {
    let scene = scene(0.85, 0.3);
    let body = Body::new(&scene.coin);
    for tilting in [false, true] {
        let rule = DecisionRule::new(&scene, tilting, 2e-3);
        for (sin, well) in [(1.0, Decided::Side), (0.1, Decided::Face)] {
            let rest = lying(&body, sin);
            let missing = 1.0 - rest.energy;
            let with = |energy: f64| DecisionState { energy, ..rest };
            assert_eq!(rule.decide(&with(1.0 - 1e-3 * missing)), well, "{sin}");
            assert_eq!(rule.decide(&with(1.0 + 1e-3 * missing)), Decided::Open);
        }
    }
}

/// R/D of H/R = 0.85 is 0.92: rolling at 2 has an energy of 3 beside the potential of 0.92.
#[test]
fn a_coin_that_rolls_straight_is_on_its_side_and_one_that_turns_may_tip() {
    let scene = scene(0.85, 0.3);
    let body = Body::new(&scene.coin);
    let rolls = |turn: f64| {
        let state = DecisionState {
            vy: -2.0,
            axial: 2.0 / body.radius,
            vertical: turn,
            ..lying(&body, 1.0)
        };
        moving(&body, state, 0.0)
    };
    let rule = DecisionRule::new(&scene, true, 2e-3);
    assert_eq!(rule.decide(&rolls(0.0)), Decided::Side);
    assert_eq!(rule.decide(&rolls(0.05)), Decided::Side);
    assert_eq!(rule.decide(&rolls(0.3)), Decided::Open);
    assert_eq!(rule.decide(&rolls(-0.3)), Decided::Open);
    let by_energy = DecisionRule::new(&scene, false, 2e-3);
    assert_eq!(by_energy.decide(&rolls(0.0)), Decided::Open);
}

/// h = 0.707, and friction leaves sqrt(1.09) − 0.3 × 0.707 = 0.832 of the barrier of 1: a coin that
/// rises at less than sqrt(2 × 0.125) = 0.5 cannot be tipped. Where friction alone tips the coin
/// (μh > R, here H/R = 7) nothing is left out.
#[test]
fn friction_lowers_the_barrier_of_a_coin_that_slides_flat() {
    let decide = |ratio: f64, sin: f64, rises: f64| {
        let scene = scene(ratio, 0.3);
        let body = Body::new(&scene.coin);
        let state = DecisionState {
            vx: 3.0,
            axial: 1.0,
            ..lying(&body, sin)
        };
        DecisionRule::new(&scene, true, 2e-3).decide(&moving(&body, state, rises))
    };
    assert_eq!(decide(2.0, 0.0, 0.49), Decided::Face);
    assert_eq!(decide(2.0, 0.0, 0.51), Decided::Open);
    assert_eq!(decide(2.0, 3e-3, 0.0), Decided::Open);
    assert_eq!(decide(6.0, 0.0, 0.0), Decided::Face);
    assert_eq!(decide(7.0, 0.0, 0.0), Decided::Open);
}

/// Without friction the horizontal velocity stays what it is, under either decision.
#[test]
fn without_friction_sliding_is_left_out() {
    let scene = scene(2.0, 0.0);
    let body = Body::new(&scene.coin);
    for tilting in [false, true] {
        let rule = DecisionRule::new(&scene, tilting, 2e-3);
        for (sin, well) in [(1.0, Decided::Side), (0.3, Decided::Face)] {
            let state = DecisionState {
                vx: 3.0,
                vy: -4.0,
                ..lying(&body, sin)
            };
            assert_eq!(rule.decide(&moving(&body, state, 0.0)), well, "{sin}");
        }
    }
}

/// A coin flat on its face that spins about its axis at ω_a has Ω_z = Ω_a. At the balance, c = ±h,
/// the energy of turning is k_t Ω_a²(1 ∓ h)²/(2R²), which adds to the barrier of 1.
#[test]
fn without_any_friction_the_spin_about_the_vertical_traps_the_coin() {
    let scene = scene(1.0, 0.0);
    let body = Body::new(&scene.coin);
    let rule = DecisionRule::new(&scene, false, 0.0);
    let axial = 8.0;
    let vertical = axial * body.ka / body.kt;
    let turn = vertical * (1.0 - body.half) / body.radius;
    let trap = 1.0 + 0.5 * body.kt * turn * turn;
    assert!(trap > 1.5, "{trap}");
    let spins = |free: f64| DecisionState {
        energy: free + 0.5 * body.ka * axial * axial,
        axial,
        vertical,
        ..lying(&body, 0.0)
    };
    assert_eq!(rule.decide(&spins(trap - 1e-3)), Decided::Face);
    assert_eq!(rule.decide(&spins(trap + 1e-3)), Decided::Open);
    assert_eq!(
        rule.in_time_steps().decide(&spins(trap - 1e-3)),
        Decided::Open
    );
    let drags = scene.with_drag(crate::Drag::new(0.0, 0.1).expect("good drag"));
    assert_eq!(
        DecisionRule::new(&drags, false, 0.0).decide(&spins(trap - 1e-3)),
        Decided::Open
    );
}

#[test]
fn only_a_smooth_elastic_surface_loses_nothing() {
    let rule = |mu: f64| DecisionRule::new(&scene(1.0, mu), true, 0.0);
    assert!(rule(0.0).loses_nothing(1.0));
    assert!(!rule(0.0).loses_nothing(0.99));
    assert!(!rule(0.1).loses_nothing(1.0));
}

/// R = 0.8 and h = 0.6.
#[test]
fn the_wells_meet_where_the_centre_is_above_the_rim() {
    let scene = scene(1.5, 0.3);
    for tilting in [false, true] {
        let rule = DecisionRule::new(&scene, tilting, 2e-3);
        assert_eq!(rule.is_tilting(), tilting);
        assert!((rule.balance() - 0.6).abs() < 1e-15);
        assert_eq!(rule.well(0.599), Decided::Side);
        assert_eq!(rule.well(0.601), Decided::Face);
    }
}

/// Each of the rates alone rocks the coin, in either direction. With H/R = 7 friction alone tips it.
#[test]
fn a_coin_lies_flat_that_neither_leans_nor_rocks() {
    let flat_sine = 1e-2;
    let rule = |ratio: f64| DecisionRule::new(&scene(ratio, 0.3), true, flat_sine);
    let small = flat_sine * Body::new(&scene(2.0, 0.3).coin).radius;
    let (less, more) = (0.99 * small, 1.01 * small);
    assert!(rule(2.0).lies_flat(less, [less, -less, less]));
    assert!(!rule(2.0).lies_flat(more, [0.0; 3]));
    for i in 0..3 {
        for rate in [-more, more] {
            let mut rocking = [0.0; 3];
            rocking[i] = rate;
            assert!(!rule(2.0).lies_flat(0.0, rocking), "{i}: {rate}");
        }
    }
    assert!(!rule(7.0).lies_flat(0.0, [0.0; 3]));
}

/// A tangential impulse p at the contact changes v_y by p and ω_a by Rp/I_a. Rolling keeps the least energy
/// that v_y and ω_a can be brought to, found here by trying impulses: the energy is quadratic in p, so that
/// of the best of the grid is too large by at most (1 + R²/k_a) δ²/8 < 1e-7 with steps of δ = 5e-4.
#[test]
fn what_no_impulse_can_take_from_rolling_is_not_loose() {
    let scene = scene(0.85, 0.3);
    let body = Body::new(&scene.coin);
    let rule = DecisionRule::new(&scene, true, 2e-3);
    for (vx, vy, axial) in [(0.3, -1.0, 2.0), (0.0, 1.5, 0.7), (-0.4, 0.0, -3.0)] {
        let state = DecisionState {
            vx,
            vy,
            axial,
            ..lying(&body, 1.0)
        };
        let state = moving(&body, state, 0.0);
        let after = |p: f64| {
            let (vy, axial) = (vy + p, axial + body.radius * p / body.ka);
            0.5 * (vy * vy + body.ka * axial * axial)
        };
        let kept = (-8000..=8000)
            .map(|i| after(5e-4 * f64::from(i)))
            .fold(f64::INFINITY, f64::min);
        let loose = rule.loose_energy(&state);
        assert!((state.energy - kept - loose).abs() < 2e-7, "{loose}");
    }
}

/// Without friction nothing turns the horizontal velocity or the spin about the axis into tilt.
#[test]
fn without_friction_neither_sliding_nor_spinning_is_loose() {
    let scene = scene(0.85, 0.0);
    let body = Body::new(&scene.coin);
    let rule = DecisionRule::new(&scene, true, 2e-3);
    for (vx, vy, axial) in [(0.0, 0.0, 0.0), (3.0, -4.0, 0.0), (-1.0, 0.5, 5.0)] {
        let state = DecisionState {
            vx,
            vy,
            axial,
            ..lying(&body, 0.95)
        };
        let loose = rule.loose_energy(&moving(&body, state, 0.3));
        let rest = lying(&body, 0.95).energy + 0.5 * 0.3 * 0.3;
        assert!((loose - rest).abs() < 1e-13, "{loose}");
    }
}

/// At a tilt with the cosine c, L_a = k_a ω_a and L_z leave the component b across the axis, in the plane of
/// both, with L_z = c L_a + s b: the coin turns with at least the energy b²/(2k_t). To leave its side it may
/// pass the balance of either rim, c = ±h; to leave a face, that of its lower rim.
#[test]
fn without_any_friction_a_coin_is_held_by_the_balances_that_it_can_reach() {
    let scene = scene(1.0, 0.0);
    let body = Body::new(&scene.coin);
    let rule = DecisionRule::new(&scene, false, 0.0);
    for (axial, vertical) in [(6.0, 3.0), (-6.0, 3.0), (6.0, -3.0), (0.0, 4.0)] {
        let over = |cos: f64| {
            let along = body.ka * axial;
            let across = (body.kt * vertical - along * cos) / body.radius;
            1.0 + across * across / (2.0 * body.kt)
        };
        let (near, far) = (over(body.half), over(-body.half));
        for (sin, well, least) in [
            (1.0, Decided::Side, near.min(far)),
            (0.1, Decided::Face, near),
        ] {
            let with = |free: f64| DecisionState {
                energy: free + 0.5 * body.ka * axial * axial,
                axial,
                vertical,
                ..lying(&body, sin)
            };
            assert!(least > 1.1, "{least}");
            assert_eq!(rule.decide(&with(least - 1e-3)), well, "{axial} {sin}");
            assert_eq!(rule.decide(&with(least + 1e-3)), Decided::Open);
        }
    }
}

/// The state of a coin with this energy above that of lying still as it leans.
fn above_rest(body: &Body, sin: f64, energy: f64) -> DecisionState<f64> {
    let rest = lying(body, sin);
    DecisionState {
        energy: rest.energy + energy,
        ..rest
    }
}

/// Whether the rule takes it for the limit of the energy of a coin at rest.
fn rests_below(rule: &DecisionRule, body: &Body, sin: f64, limit: f64) -> bool {
    let well = rule.well(lying(body, sin).cos);
    let decide = |part: f64| rule.decide(&above_rest(body, sin, part * limit));
    decide(0.999) == well && decide(1.001) == Decided::Open
}

/// Contour friction takes N ρ_c from each unit of angle that a coin rolls, so ρ_c/R from each of way.
/// Sliding takes μ. With more friction on its face it is limited by the time 1 in which it falls flat, within
/// which it moves by sqrt(2ε).
#[test]
fn on_a_table_with_an_edge_a_coin_rests_once_it_gets_no_farther_than_the_way() {
    let scene = scene(0.85, 0.3);
    let body = Body::new(&scene.coin);
    let rule = |mu: f64, rho_over_radius: f64| {
        let surface = Surface::new(0.5, mu)
            .and_then(|it| it.with_friction_lengths(rho_over_radius * scene.coin.radius_m(), 0.0))
            .and_then(|it| it.with_table_radius(0.2))
            .expect("a good table");
        DecisionRule::new(&tossed(scene.coin, surface), false, 2e-3)
    };
    for sin in [0.97, 1.0] {
        assert!(rests_below(&rule(0.3, 0.02), &body, sin, WAY * 0.02));
        assert!(rests_below(&rule(0.3, 0.0), &body, sin, LEAST_RESTING));
    }
    for sin in [0.0, 0.1, 0.3] {
        assert!(rests_below(&rule(0.01, 0.02), &body, sin, WAY * 0.01));
        assert!(rests_below(&rule(0.3, 0.02), &body, sin, 0.5 * WAY * WAY));
    }
}

/// Without an edge nobody asks how far a coin goes, and without friction it slides on for ever.
#[test]
fn rest_is_awaited_only_where_motion_matters_and_ends() {
    let level = |mu: f64| scene(0.85, mu).surface;
    let edged = |mu: f64| level(mu).with_table_radius(0.2).expect("a good table");
    let tilt = TableTilt::new(1.0, 0.0).expect("a good tilt");
    let tilted = level(0.3).with_tilt(tilt).expect("friction holds it");
    for (surface, awaits) in [
        (level(0.3), false),
        (level(0.0), false),
        (edged(0.0), false),
        (edged(0.3), true),
        (tilted, true),
    ] {
        let scene = tossed(scene(0.85, 0.3).coin, surface);
        let rule = DecisionRule::new(&scene, false, 2e-3);
        assert_eq!(rule.awaits_rest(), awaits, "{surface:?}");
        let body = Body::new(&scene.coin);
        let rolls = rule.decide(&above_rest(&body, 1.0, 0.01));
        assert_eq!(rolls == Decided::Open, awaits, "{surface:?}");
    }
}

fn on_slope(ratio: f64, mu: f64, slope: f64) -> DecisionRule {
    let tilt = TableTilt::new(libm::atan(slope).to_degrees(), 0.0).expect("a good tilt");
    let scene = scene(ratio, mu);
    let surface = scene.surface.with_tilt(tilt).expect("friction holds it");
    DecisionRule::new(&tossed(scene.coin, surface), false, 2e-3)
}

/// The pull downhill, tan β of the weight, works against sliding friction.
#[test]
fn on_a_slope_a_coin_slides_farther_before_it_rests_and_on_its_side_it_may_roll() {
    let (mu, slope) = (0.02, 0.009);
    let rule = on_slope(0.85, mu, slope);
    let body = Body::new(&scene(0.85, mu).coin);
    for sin in [0.0, 0.1] {
        assert!(rests_below(&rule, &body, sin, WAY * (mu - slope)));
    }
    assert_eq!(rule.decide(&lying(&body, 1.0)), Decided::Open);
}

/// A tall coin at rest on its face, level or leaning, turns about its rim under a pull downhill. In small
/// steps of the tilt up to the balance its centre rises and goes downhill: the pull must not do the work of
/// the rise, with twice the way to spare.
#[test]
fn a_slope_tips_a_tall_coin_whose_centre_has_little_to_rise() {
    let (ratio, mu) = (8.0, 0.3);
    let body = Body::new(&scene(ratio, mu).coin);
    for sin in [0.0, 0.1] {
        let rest = lying(&body, sin);
        let (from, to) = (libm::asin(sin), libm::acos(body.half));
        let step = (to - from) / 1e4;
        let (mut rise, mut along) = (0.0, 0.0);
        for i in 0..10_000 {
            let (s, c) = libm::sincos(from + step * (f64::from(i) + 0.5));
            rise += step * (body.radius * c - body.half * s);
            along += step * (body.half * c + body.radius * s);
        }
        let steepest = rise / (along + 2.0 * WAY);
        assert!(steepest < 0.17, "{steepest} within the tilts of tables");
        let decide = |slope: f64| on_slope(ratio, mu, slope).decide(&rest);
        assert_eq!(decide(0.999 * steepest), Decided::Face, "{sin}");
        assert_eq!(decide(1.001 * steepest), Decided::Open, "{sin}");
    }
}

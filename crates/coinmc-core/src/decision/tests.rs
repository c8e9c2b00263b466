//! The rule against hand calculations, one for each of its parts.

use super::*;
use crate::{Coin, Surface};

fn scene(ratio: f64, mu: f64) -> Scene {
    let coin = Coin::cylinder(ratio, 0.01).expect("a good coin");
    let surface = Surface::new(0.5, mu).expect("a good surface");
    Scene::new(coin, surface, 9.81).expect("good gravity")
}

/// A coin at rest where it lies on the surface, tilted by the angle with this sine.
fn lying(body: &Body, sin: f64) -> DecisionState<f64> {
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
fn moving(body: &Body, state: DecisionState<f64>, rises: f64) -> DecisionState<f64> {
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
                vy: 2.0,
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

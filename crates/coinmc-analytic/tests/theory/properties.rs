//! Properties of every coin, at random ratios over 24 decades.

use coinmc_analytic::precession::thick;
use coinmc_analytic::{FaceProbabilities, Rule};
use proptest::prelude::*;

/// Rounding of a probability near 1: a few units in the last place.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

fn ratio() -> impl Strategy<Value = f64> {
    (-12.0..12.0).prop_map(libm::exp10)
}

fn rule() -> impl Strategy<Value = Rule> {
    prop::sample::select(Rule::ALL.to_vec())
}

fn psi() -> impl Strategy<Value = f64> {
    0.0..std::f64::consts::PI
}

/// Each in `[0, 1]` and the sum 1, up to the rounding of three numbers.
fn is_distribution(p: &FaceProbabilities) -> bool {
    let each = [p.heads, p.tails, p.side];
    each.iter().all(|p| (0.0..=1.0).contains(p))
        && (each.iter().sum::<f64>() - 1.0).abs() <= 8.0 * f64::EPSILON
}

proptest! {
    #[test]
    fn thicker_coins_rest_on_their_side(rule in rule(), x in ratio(), step in 1e-9f64..5.0) {
        let (thin, thick) = (rule.probabilities(x), rule.probabilities(x * libm::exp(step)));
        // A relative step of 1e-9 changes the smaller of the two by at least half of 1e-9 of
        // itself, far above rounding. The larger may stay the same or go back by no more than its
        // rounding.
        if thin.side < 0.5 {
            prop_assert!(thin.side < thick.side);
        } else {
            prop_assert!(thin.faces() > thick.faces());
        }
        prop_assert!(thin.side <= thick.side + ROUNDING);
        prop_assert!(thin.faces() >= thick.faces() - ROUNDING);
    }

    #[test]
    fn outcomes_exhaust_the_coin_and_favour_no_face(rule in rule(), x in ratio()) {
        let p = rule.probabilities(x);
        prop_assert!(is_distribution(&p));
        prop_assert_eq!(p.heads, p.tails);
        prop_assert_eq!(p.side, rule.p_side(x));
    }

    #[test]
    fn a_section_turned_by_a_right_angle_swaps_side_and_faces(x in ratio()) {
        // The rules of the plane see a rectangle, so 4/x and x are one coin; 4/x rounds, and the
        // odds depend on its cube.
        for rule in [Rule::Arc, Rule::CrossSection, Rule::WellDepthFlat] {
            let (upright, lying) = (rule.probabilities(x), rule.probabilities(4.0 / x));
            prop_assert!((upright.side / lying.faces() - 1.0).abs() < 20.0 * f64::EPSILON);
        }
    }

    #[test]
    fn precession_gives_a_distribution_that_favours_the_start(x in ratio(), psi in psi()) {
        let p = thick::probabilities(x, psi);
        prop_assert!(is_distribution(&p));
        // Equal at ψ = π/2 up to rounding.
        prop_assert!(p.heads >= p.tails * (1.0 - 1e-12));
    }

    #[test]
    fn thicker_precessing_coins_rest_on_their_side(
        x in ratio(), psi in psi(), step in 1e-6f64..5.0,
    ) {
        let thin = thick::probabilities(x, psi);
        let thick = thick::probabilities(x * libm::exp(step), psi);
        // Clipped outcomes stay the same; the others may go back by no more than their rounding.
        prop_assert!(thin.side <= thick.side + ROUNDING);
        prop_assert!(thin.heads >= thick.heads - ROUNDING);
        prop_assert!(thin.tails >= thick.tails - ROUNDING);
        // 1e-6 more thickness raises P(side) by at least 1e-6 of itself until it nears 1.
        prop_assert!(thin.side == 0.0 || thin.side > 0.5 || thin.side < thick.side);
    }

    #[test]
    fn the_sense_of_the_angular_momentum_does_not_matter(x in ratio(), psi in 0.1f64..1.5) {
        // π − ψ is rounded to 2e-16; away from clipping the result changes in proportion.
        let opposite = std::f64::consts::PI - psi;
        let (a, b) = (thick::probabilities(x, psi), thick::probabilities(x, opposite));
        prop_assert!((a.heads - b.heads).abs() < 1e-7 && (a.side - b.side).abs() < 1e-7);
    }
}

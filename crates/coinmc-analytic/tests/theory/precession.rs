//! The precessing coin: free motion of the rigid body, then its landing at every phase.

use crate::measure::intervals;
use crate::tipping::{Rest, rest};
use coinmc_analytic::precession::{thick, thin};
use coinmc_analytic::{FaceProbabilities, arc};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};

type Vector = [f64; 3];

fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn add(a: Vector, scale: f64, b: Vector) -> Vector {
    std::array::from_fn(|i| a[i] + scale * b[i])
}

/// The normal after it has circled the angular momentum by `phase` (Rodrigues' rotation of `z`).
fn normal(psi: f64, phase: f64) -> Vector {
    let axis = [libm::sin(psi), 0.0, libm::cos(psi)];
    let z = [0.0, 0.0, 1.0];
    let turned = add(
        z.map(|c| c * libm::cos(phase)),
        libm::sin(phase),
        cross(axis, z),
    );
    add(turned, axis[2] * (1.0 - libm::cos(phase)), axis)
}

/// Body axes in space (rows) and angular velocity in the body.
#[derive(Clone, Copy)]
struct State {
    axes: [Vector; 3],
    spin: Vector,
}

impl State {
    /// Euler's equations without torque, and the rotation of the axes.
    fn rate(&self, inertia: Vector) -> Self {
        let w = self.spin;
        let momentum = std::array::from_fn(|i| inertia[i] * w[i]);
        let torque = cross(momentum, w);
        let in_space: Vector =
            std::array::from_fn(|c| (0..3).map(|i| w[i] * self.axes[i][c]).sum());
        Self {
            axes: self.axes.map(|axis| cross(in_space, axis)),
            spin: std::array::from_fn(|i| torque[i] / inertia[i]),
        }
    }

    fn plus(&self, scale: f64, rate: &Self) -> Self {
        Self {
            axes: std::array::from_fn(|i| add(self.axes[i], scale, rate.axes[i])),
            spin: add(self.spin, scale, rate.spin),
        }
    }

    /// One step of the classical Runge–Kutta method.
    fn step(&self, dt: f64, inertia: Vector) -> Self {
        let a = self.rate(inertia);
        let b = self.plus(0.5 * dt, &a).rate(inertia);
        let c = self.plus(0.5 * dt, &b).rate(inertia);
        let d = self.plus(dt, &c).rate(inertia);
        self.plus(dt / 6.0, &a)
            .plus(dt / 3.0, &b)
            .plus(dt / 3.0, &c)
            .plus(dt / 6.0, &d)
    }
}

#[test]
fn free_coin_circles_its_angular_momentum_at_a_constant_rate() {
    for (ratio, psi) in [(0.1f64, 1.3f64), (1.0, 1.0), (1.7, 0.6), (4.0, 1.5)] {
        let across = (3.0 + ratio * ratio) / 12.0;
        let inertia = [across, across, 0.5];
        // Angular momentum of size `across`, so that the normal should turn at 1 rad/s.
        let spin = [libm::sin(psi), 0.0, libm::cos(psi) * across / 0.5];
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let mut state = State { axes, spin };
        let steps = 20_000;
        let dt = TAU / f64::from(steps);
        for i in 1..=steps {
            state = state.step(dt, inertia);
            let (expected, u) = (normal(psi, f64::from(i) * dt), state.axes[2]);
            // Fourth order: 2π·dt⁴ = 6e-14 times a factor of order one; rounding of 2e4 steps,
            // 1e-12.
            assert!(
                (0..3).all(|c| (u[c] - expected[c]).abs() < 1e-10),
                "{ratio} {psi} {i}"
            );
        }
    }
}

/// Shares of one circle of the normal that come to rest on each face.
fn shares_of_circle(ratio: f64, psi: f64) -> FaceProbabilities {
    let share = |face| {
        let phases = intervals(0.0, TAU, 20_000, |phase| {
            rest(ratio, normal(psi, phase)) == face
        });
        phases.iter().map(|(a, b)| b - a).sum::<f64>() / TAU
    };
    FaceProbabilities {
        heads: share(Rest::Heads),
        tails: share(Rest::Tails),
        side: share(Rest::Side),
    }
}

fn assert_close(found: FaceProbabilities, expected: FaceProbabilities, tolerance: f64, what: &str) {
    let near = |a: f64, b: f64| (a - b).abs() < tolerance;
    assert!(
        near(found.heads, expected.heads)
            && near(found.tails, expected.tails)
            && near(found.side, expected.side),
        "{what}: {found:?}, expected {expected:?}"
    );
}

#[test]
fn thick_coin_is_the_time_average_over_one_circle() {
    for ratio in [0.0, 0.05, 0.5, 0.738, 1.0, 1.5, 3.0, 10.0] {
        for psi_deg in [
            5.0f64, 20.0, 40.0, 47.0, 60.0, 70.0, 85.0, 90.0, 100.0, 130.0, 150.0,
        ] {
            let psi = psi_deg.to_radians();
            // At the ends u_z, rounded to 4e-16, crosses with a slope of at least 1e-4 (no case
            // grazes).
            let what = format!("{ratio} {psi_deg}");
            assert_close(
                shares_of_circle(ratio, psi),
                thick::probabilities(ratio, psi),
                1e-11,
                &what,
            );
        }
    }
}

#[test]
fn thin_coin_is_the_time_for_which_heads_looks_up() {
    for psi_deg in [10.0f64, 44.0, 46.0, 60.0, 80.99, 90.0, 110.0, 140.0] {
        let psi = psi_deg.to_radians();
        let up = intervals(0.0, TAU, 20_000, |phase| normal(psi, phase)[2] > 0.0);
        let share = up.iter().map(|(a, b)| b - a).sum::<f64>() / TAU;
        // As above; near 45° the slope of u_z at its zero is 0.3 at least.
        assert!(
            (share - thin::p_same_side(psi)).abs() < 1e-14,
            "{psi_deg}: {share}"
        );
        assert!(
            (1.0 - share - thin::p_other_side(psi)).abs() < 1e-14,
            "{psi_deg}: {share}"
        );
    }
}

#[test]
fn thin_formula_is_the_published_one() {
    for i in 1..100 {
        let psi = FRAC_PI_4 * (1.0 + f64::from(i) / 100.0);
        let cot = 1.0 / libm::tan(psi);
        // asin amplifies the rounding of cot² by up to 1/sqrt(1 − cot⁴) = 5 here.
        let published = 0.5 + libm::asin(cot * cot) / PI;
        assert!((thin::p_same_side(psi) - published).abs() < 1e-15, "{psi}");
    }
}

#[test]
fn thick_coin_reduces_to_the_arc_rule_and_to_the_thin_coin() {
    for ratio in [1e-12, 1e-3, 0.5, 1.1547, 2.0, 50.0, 1e12] {
        let (flip, rule) = (thick::p_side(ratio, FRAC_PI_2), arc::p_side(ratio));
        // A dozen roundings.
        assert!(
            (flip / rule - 1.0).abs() < 12.0 * f64::EPSILON,
            "{ratio}: {flip} {rule}"
        );
    }
    for psi in [0.3, 0.8, 1.0, 1.4, FRAC_PI_2, 2.0, 3.0] {
        let thin = FaceProbabilities {
            heads: thin::p_same_side(psi),
            tails: thin::p_other_side(psi),
            side: 0.0,
        };
        assert_close(
            thick::probabilities(0.0, psi),
            thin,
            4.0 * f64::EPSILON,
            "ratio 0",
        );
    }
}

#[test]
fn angles_outside_the_domain_have_no_probability() {
    for psi in [-1e-9, 3.2, f64::NAN, f64::INFINITY] {
        assert!(thin::p_same_side(psi).is_nan() && thin::p_other_side(psi).is_nan());
        assert!(thick::probabilities(1.0, psi).heads.is_nan());
        assert!(thick::fair_ratio(0.5, psi).is_nan());
    }
    assert!(thick::p_side(-1.0, 1.0).is_nan() && thick::fair_ratio(1.1, 1.0).is_nan());
    for (ratio, psi, heads, side) in [
        (f64::INFINITY, 1.0, 0.0, 1.0),
        (f64::INFINITY, FRAC_PI_2, 0.0, 1.0),
        (1e12, 0.0, 1.0, 0.0),
        (0.0, 0.0, 1.0, 0.0),
        (f64::INFINITY, PI - 1e-3, 0.0, 1.0),
    ] {
        let p = thick::probabilities(ratio, psi);
        assert_eq!(
            (p.heads, p.tails, p.side),
            (heads, 0.0, side),
            "{ratio} {psi}"
        );
    }
}

//! The equations of a sliding corner, and one step of their integration.
//!
//! With n the direction of the slip γ, s = sin δ, c = cos δ and r = (−s, −c) the corner seen from
//! the centre, Newton–Euler with friction −μ n N and the corner kept on the plane give
//!
//! N = k(1 − ω²c)/A,  A = k + s² + μ n s c,
//! δ' = ω,  ω' = N(s + μ n c)/k,  γ' = ω²s − N[(1 + c²/k)μ n + s c/k].
//!
//! Integrated by Dormand & Prince's embedded pair of order 5(4), J. Comput. Appl. Math. 6 (1980)
//! 19. Where A → 0 the force that sliding needs grows without bound (Painlevé 1895).

use crate::dormand_prince::{Flow, LAST_DIFFERENCE, combine, stages};
use coinmc_lanes::{Lane, Mask, sin_cos};
use std::f64::consts::FRAC_PI_2;

/// A/k below which the configuration counts as Painlevé's.
pub(super) const JAM: f64 = 1e-2;

/// (δ, ω, γ, x)
pub(super) type SlideState<L = f64> = [L; 4];

/// A state and its rates of change.
#[derive(Debug, Clone, Copy)]
pub(super) struct RatedState<L = f64> {
    pub(super) state: SlideState<L>,
    pub(super) rates: SlideState<L>,
    /// (sin δ, cos δ)
    pub(super) angle: (L, L),
}

/// The equations of motion for one direction of slip, of one corner or of one per lane.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sliding<L = f64> {
    pub(super) k: f64,
    /// μ n, signed friction.
    pub(super) friction: L,
}

/// A step without the rates at its end.
pub(super) struct SlideStep<L: Lane> {
    /// The state of order 5.
    pub(super) state: SlideState<L>,
    /// The error estimate without the seventh stage.
    pub(super) partial: SlideState<L>,
    /// Whether the equations hold in all stages.
    pub(super) possible: L::Mask,
}

/// A step with the rates at its end.
pub(super) struct WholeStep<L: Lane> {
    pub(super) end: RatedState<L>,
    /// Largest relative error.
    pub(super) error: L,
    /// Whether the equations hold in all stages.
    pub(super) possible: L::Mask,
    /// Whether they hold at the end.
    pub(super) sound: L::Mask,
}

impl<L: Lane> Sliding<L> {
    /// A/k at an angle, given by its sine and cosine.
    #[inline(always)]
    pub(super) fn openness(&self, (sin, cos): (L, L)) -> L {
        L::splat(1.0) + (sin + self.friction * cos) * sin / L::splat(self.k)
    }

    /// A state with its rates, and whether the equations hold there: away from Painlevé's
    /// configuration and not far out of range.
    #[inline(always)]
    pub(super) fn at(&self, state: &SlideState<L>) -> (RatedState<L>, L::Mask) {
        let [delta, omega, slip, _] = *state;
        let one = L::splat(1.0);
        let inside = delta.abs().lt(L::splat(FRAC_PI_2));
        let (sin, cos) = sin_cos(delta);
        let w2 = omega * omega;
        let inverse_k = L::splat(1.0 / self.k);
        let a = one + (sin + self.friction * cos) * sin * inverse_k;
        // NaN fails both comparisons
        let open = L::splat(0.5 * JAM).lt(a);
        let normal = (one - w2 * cos) / a;
        let lever = self.friction + (self.friction * cos + sin) * cos * inverse_k;
        let rates = [
            omega,
            normal * (sin + self.friction * cos) * inverse_k,
            w2 * sin - normal * lever,
            slip + omega * cos,
        ];
        let at = RatedState {
            state: *state,
            rates,
            angle: (sin, cos),
        };
        (at, inside & open)
    }

    /// One step of length `h`.
    #[inline(always)]
    pub(super) fn step(&self, start: &RatedState<L>, h: L) -> SlideStep<L> {
        let mut flow = CheckedFlow {
            sliding: self,
            sound: L::Mask::splat(true),
        };
        let stages = stages(&mut flow, &start.state, &start.rates, h);
        let possible = flow.sound;
        match stages {
            Some(stages) => SlideStep {
                state: stages.end,
                partial: combine(&[L::splat(0.0); 4], h, stages.difference(&start.rates)),
                possible,
            },
            None => SlideStep {
                state: start.state,
                partial: start.state,
                possible,
            },
        }
    }

    /// One step of length `h`, with its error and the rates at its end.
    #[inline(always)]
    pub(super) fn whole_step(&self, start: &RatedState<L>, h: L) -> WholeStep<L> {
        let step = self.step(start, h);
        let (end, sound) = self.at(&step.state);
        let error = combine(&step.partial, h, [(LAST_DIFFERENCE, &end.rates)]);
        // of all components but the position
        let mut largest = L::splat(0.0);
        for (error, state) in error.iter().zip(&end.state).take(3) {
            largest = largest.max(error.abs() / (L::splat(1.0) + state.abs()));
        }
        WholeStep {
            end,
            error: largest,
            possible: step.possible,
            sound,
        }
    }
}

/// The equations as the stages of a step evaluate them, and whether they have held each time.
struct CheckedFlow<'a, L: Lane> {
    sliding: &'a Sliding<L>,
    sound: L::Mask,
}

impl<L: Lane> Flow<4, L> for &mut CheckedFlow<'_, L> {
    #[inline(always)]
    fn rates(&mut self, y: &SlideState<L>) -> Option<SlideState<L>> {
        let (at, sound) = self.sliding.at(y);
        self.sound = self.sound & sound;
        self.sound.any().then_some(at.rates)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dormand_prince::{Step, System};

    fn integrate(steps: u32) -> SlideState {
        let sliding = Sliding {
            k: 0.3,
            friction: 0.4,
        };
        let mut state = [-0.3, -0.4, 3.0, 0.0];
        for _ in 0..steps {
            let (start, _) = sliding.at(&state);
            let h = 1.5 / f64::from(steps);
            state = sliding.step(&start, h).state;
        }
        state
    }

    /// Halving the step divides the error by 2⁵. Estimated from three step lengths, the order of
    /// the slowest component is within 0.4 of 5; no component has a lower one (symmetry raises some
    /// to 6).
    #[test]
    fn converges_with_order_five() {
        let [a, b, c] = [32, 64, 128].map(integrate);
        let order = |i: usize| libm::log2((a[i] - b[i]).abs() / (b[i] - c[i]).abs());
        let slowest = (0..4).map(order).fold(f64::INFINITY, f64::min);
        assert!((slowest - 5.0).abs() < 0.4, "{slowest}");
    }

    /// The energy falls by the work of friction and by nothing else: E' = −μ N |γ|.
    #[test]
    fn energy_changes_by_the_work_of_friction() {
        let sliding = Sliding {
            k: 0.3,
            friction: -0.7,
        };
        let y = [0.2, -0.4, -0.5, 0.0];
        let energy = |y: &SlideState| {
            let (s, c) = sin_cos(y[0]);
            let (vx, vz) = (y[2] + y[1] * c, -y[1] * s);
            0.5 * (vx * vx + vz * vz + sliding.k * y[1] * y[1]) + c
        };
        let rates = sliding.at(&y).0.rates;
        let h = 1e-5;
        let shifted = |h: f64| std::array::from_fn(|i| y[i] + h * rates[i]);
        // central difference: error h² times a third derivative of order 1
        let change = (energy(&shifted(h)) - energy(&shifted(-h))) / (2.0 * h);
        let (_, c) = sin_cos(y[0]);
        let normal = (1.0 - y[1] * y[1] * c) / sliding.openness(sin_cos(y[0]));
        assert!((change - (-0.7 * normal * 0.5)).abs() < 1e-9, "{change}");
    }

    /// The error of a step is that of the embedded pair, the worst of angle, angular velocity and slip, each over 1
    /// plus its own size.
    #[test]
    fn errors_are_relative_to_the_state() {
        struct Scalar(Sliding);
        impl System<4> for Scalar {
            fn rates(&self, y: &[f64; 4]) -> [f64; 4] {
                self.0.at(y).0.rates
            }
        }
        for (k, friction, y) in [
            (0.3, 0.4, [-0.3, -0.4, 3.0, 0.0]),
            (0.2, -0.4, [-0.3, 0.7, -40.0, 0.0]),
            (0.3, 0.4, [0.1, -3.0, 0.2, 100.0]),
        ] {
            let sliding = Sliding { k, friction };
            let (start, _) = sliding.at(&y);
            let embedded = Step::take(&Scalar(sliding), &y, &start.rates, 0.2);
            let shares = |i: usize| embedded.error[i].abs() / (1.0 + embedded.end[i].abs());
            let expected = (0..3).map(shares).fold(0.0, f64::max);
            let found = sliding.whole_step(&start, 0.2).error;
            // the error is a difference of terms of order 1
            assert!((found - expected).abs() < 1e-14, "{found} {expected}");
            assert!(expected > 1e-9, "{expected}");
        }
    }
}

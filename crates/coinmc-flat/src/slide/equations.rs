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

use crate::dormand_prince::{LAST_DIFFERENCE, combine, stages};
use coinmc_core::trig::sin_cos;
use std::f64::consts::FRAC_PI_2;

/// A/k below which the configuration counts as Painlevé's.
pub(super) const JAM: f64 = 1e-2;

/// (δ, ω, γ, x)
pub(super) type Slide = [f64; 4];

/// The end of a step: where, and how fast it goes on.
#[derive(Clone, Copy)]
pub(super) struct Arrival {
    pub(super) state: Slide,
    pub(super) rates: Slide,
}

/// The equations of motion for one direction of slip.
pub(super) struct Sliding {
    pub(super) k: f64,
    /// μ n, signed friction.
    pub(super) friction: f64,
}

impl Sliding {
    /// A/k.
    #[inline]
    pub(super) fn openness(&self, delta: f64) -> f64 {
        let (sin, cos) = sin_cos(delta);
        1.0 + (sin + self.friction * cos) * sin / self.k
    }

    /// The right-hand side, or `None` next to Painlevé's configuration and far out of range.
    #[inline]
    pub(super) fn rates(&self, y: &Slide) -> Option<Slide> {
        let [delta, omega, slip, _] = *y;
        let inside = delta.abs() < FRAC_PI_2;
        let (sin, cos) = sin_cos(delta);
        let w2 = omega * omega;
        let inverse_k = 1.0 / self.k;
        let a = 1.0 + (sin + self.friction * cos) * sin * inverse_k;
        // a NaN fails both
        let open = a > 0.5 * JAM;
        if !(inside && open) {
            return None;
        }
        let normal = (1.0 - w2 * cos) / a;
        let lever = self.friction + (self.friction * cos + sin) * cos * inverse_k;
        Some([
            omega,
            normal * (sin + self.friction * cos) * inverse_k,
            w2 * sin - normal * lever,
            slip + omega * cos,
        ])
    }

    /// One step of length `h`: the state of order 5, and the error estimate but for the share of
    /// the seventh stage.
    #[inline]
    pub(super) fn step(&self, start: &Arrival, h: f64) -> Option<(Slide, Slide)> {
        let stages = stages(|y| self.rates(y), &start.state, &start.rates, h)?;
        let difference = stages.difference(&start.rates);
        Some((stages.end, combine(&[0.0; 4], h, difference)))
    }

    /// A step with the rates at its end and its relative error.
    #[inline]
    pub(super) fn step_with_error(&self, start: &Arrival, h: f64) -> Option<(Arrival, f64)> {
        let (state, partial) = self.step(start, h)?;
        let rates = self.rates(&state)?;
        let error = combine(&partial, h, [(LAST_DIFFERENCE, &rates)]);
        let relative = |i: usize| error[i].abs() / (1.0 + state[i].abs());
        Some((
            Arrival { state, rates },
            relative(0).max(relative(1)).max(relative(2)),
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn integrate(steps: u32) -> Slide {
        let sliding = Sliding {
            k: 0.3,
            friction: 0.4,
        };
        let mut state = [-0.3, -0.4, 3.0, 0.0];
        for _ in 0..steps {
            let rates = sliding.rates(&state).unwrap();
            let h = 1.5 / f64::from(steps);
            state = sliding.step(&Arrival { state, rates }, h).unwrap().0;
        }
        state
    }

    /// Halving the step divides the error by 2⁵. Seen from three step lengths the order is within
    /// 0.4 of that for the slowest component, and no less for any (symmetry raises some to 6).
    #[test]
    fn converges_with_order_five() {
        let [a, b, c] = [32, 64, 128].map(integrate);
        let order = |i: usize| libm::log2((a[i] - b[i]).abs() / (b[i] - c[i]).abs());
        let slowest = (0..4).map(order).fold(f64::INFINITY, f64::min);
        assert!((slowest - 5.0).abs() < 0.4, "{slowest}");
    }

    /// Friction takes the energy it dissipates and no other: E' = −μ N |γ|.
    #[test]
    fn energy_changes_by_the_work_of_friction() {
        let sliding = Sliding {
            k: 0.3,
            friction: -0.7,
        };
        let y = [0.2, -0.4, -0.5, 0.0];
        let energy = |y: &Slide| {
            let (s, c) = sin_cos(y[0]);
            let (vx, vz) = (y[2] + y[1] * c, -y[1] * s);
            0.5 * (vx * vx + vz * vz + sliding.k * y[1] * y[1]) + c
        };
        let rates = sliding.rates(&y).unwrap();
        let h = 1e-5;
        let shifted = |h: f64| std::array::from_fn(|i| y[i] + h * rates[i]);
        // central difference: error h² times a third derivative of order 1
        let change = (energy(&shifted(h)) - energy(&shifted(-h))) / (2.0 * h);
        let (_, c) = sin_cos(y[0]);
        let normal = (1.0 - y[1] * y[1] * c) / sliding.openness(y[0]);
        assert!((change - (-0.7 * normal * 0.5)).abs() < 1e-9, "{change}");
    }
}

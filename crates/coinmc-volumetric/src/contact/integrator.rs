//! One step of an embedded Runge–Kutta pair: Dormand & Prince 5(4), J. Comput. Appl. Math. 6
//! (1980) 19. The last stage of a step is the first of the next, so a step takes six evaluations.

use coinmc_lanes::Lane;

/// A trial step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Trial<L, const N: usize> {
    pub(crate) state: [L; N],
    /// Square of the estimated error over the error allowed, root mean square over the
    /// components: accept at <= 1.
    pub(crate) error: L,
    pub(crate) h: L,
    pub(crate) stages: [[L; N]; 6],
}

/// Rates of change of a state.
pub(crate) trait Flow<L, const N: usize> {
    /// The rates of `state`.
    fn rates(&mut self, state: &[L; N]) -> [L; N];
}

impl<L, const N: usize, F: FnMut(&[L; N]) -> [L; N]> Flow<L, N> for F {
    #[inline(always)]
    fn rates(&mut self, state: &[L; N]) -> [L; N] {
        self(state)
    }
}

/// Takes a step of length `h` from `state`, whose rates are `first`.
#[inline(always)]
pub(crate) fn step<L: Lane, const N: usize>(
    state: &[L; N],
    first: &[L; N],
    h: L,
    tolerance: f64,
    mut flow: impl Flow<L, N>,
) -> Trial<L, N> {
    let k1 = first;
    let k2 = &flow.rates(&along(state, h, &[(1.0 / 5.0, k1)]));
    let k3 = &flow.rates(&along(state, h, &[(3.0 / 40.0, k1), (9.0 / 40.0, k2)]));
    let k4 = &flow.rates(&along(
        state,
        h,
        &[(44.0 / 45.0, k1), (-56.0 / 15.0, k2), (32.0 / 9.0, k3)],
    ));
    let k5 = &flow.rates(&along(
        state,
        h,
        &[
            (19_372.0 / 6_561.0, k1),
            (-25_360.0 / 2_187.0, k2),
            (64_448.0 / 6_561.0, k3),
            (-212.0 / 729.0, k4),
        ],
    ));
    let k6 = &flow.rates(&along(
        state,
        h,
        &[
            (9_017.0 / 3_168.0, k1),
            (-355.0 / 33.0, k2),
            (46_732.0 / 5_247.0, k3),
            (49.0 / 176.0, k4),
            (-5_103.0 / 18_656.0, k5),
        ],
    ));
    let end = along(
        state,
        h,
        &[
            (35.0 / 384.0, k1),
            (500.0 / 1_113.0, k3),
            (125.0 / 192.0, k4),
            (-2_187.0 / 6_784.0, k5),
            (11.0 / 84.0, k6),
        ],
    );
    let k7 = flow.rates(&end);
    let error = [
        (71.0 / 57_600.0, k1),
        (-71.0 / 16_695.0, k3),
        (71.0 / 1_920.0, k4),
        (-17_253.0 / 339_200.0, k5),
        (22.0 / 525.0, k6),
        (-1.0 / 40.0, &k7),
    ];
    let mut squares = L::splat(0.0);
    // one quotient for two components
    for i in (0..N).step_by(2) {
        let one = allowed(state[i], end[i], tolerance);
        if i + 1 == N {
            let relative = h * weighted(&error, i) / one;
            squares += relative * relative;
        } else {
            let other = allowed(state[i + 1], end[i + 1], tolerance);
            let share = h / (one * other);
            let first = weighted(&error, i) * (other * share);
            let second = weighted(&error, i + 1) * (one * share);
            squares += first * first + second * second;
        }
    }
    Trial {
        state: end,
        error: squares * L::splat(1.0 / N as f64),
        h,
        stages: [*k1, *k3, *k4, *k5, *k6, k7],
    }
}

/// The error allowed for a component.
#[inline(always)]
fn allowed<L: Lane>(from: L, to: L, tolerance: f64) -> L {
    L::splat(tolerance) * (L::splat(1.0) + from.abs().max(to.abs()))
}

/// state + h Σ weight·rates.
#[inline(always)]
fn along<L: Lane, const N: usize, const M: usize>(
    state: &[L; N],
    h: L,
    terms: &[(f64, &[L; N]); M],
) -> [L; N] {
    let mut sum = *state;
    for (i, component) in sum.iter_mut().enumerate() {
        *component += h * weighted(terms, i);
    }
    sum
}

#[inline(always)]
fn weighted<L: Lane, const N: usize, const M: usize>(terms: &[(f64, &[L; N]); M], i: usize) -> L {
    let mut sum = L::splat(terms[0].0) * terms[0].1[i];
    for (weight, k) in &terms[1..] {
        sum += L::splat(*weight) * k[i];
    }
    sum
}

impl<L: Lane, const N: usize> Trial<L, N> {
    /// The state at the fraction `x` of the step: the fourth-order dense output of Hairer, Nørsett
    /// & Wanner, Solving Ordinary Differential Equations I, II.6.
    pub(crate) fn between(&self, start: &[L; N], x: L) -> [L; N] {
        let [k1, k3, k4, k5, k6, k7] = &self.stages;
        let weights = [
            (-12_715_105_075.0 / 11_282_082_432.0, k1),
            (87_487_479_700.0 / 32_700_410_799.0, k3),
            (-10_690_763_975.0 / 1_880_347_072.0, k4),
            (701_980_252_875.0 / 199_316_789_632.0, k5),
            (-1_453_857_185.0 / 822_651_844.0, k6),
            (69_997_945.0 / 29_380_423.0, k7),
        ];
        let rest = L::splat(1.0) - x;
        std::array::from_fn(|i| {
            let chord = self.state[i] - start[i];
            let bow = self.h * k1[i] - chord;
            let sway = chord - self.h * k7[i] - bow;
            let inner = bow + x * (sway + rest * (self.h * weighted(&weights, i)));
            start[i] + x * (chord + rest * inner)
        })
    }
}

/// Whether a trial step with this (squared) error is accepted. NaN is not.
#[inline(always)]
pub(crate) fn is_accepted<L: Lane>(error: L) -> L::Mask {
    error.le(L::splat(1.0))
}

/// The length of the next try after a try of length `h` that was rejected.
#[inline(always)]
pub(crate) fn shorter<L: Lane>(h: L, error: L) -> L {
    let finite = error.lt(L::splat(f64::INFINITY));
    L::select(finite, next_length(h, error), L::splat(0.2) * h)
}

/// The length of the next step after a step of length `h` with this (squared) error:
/// h·0.9·error^(−1/4), changed by a factor of at most 5. (The fifth root that theory asks for is
/// not an IEEE 754 operation; the fourth root corrects a little more, and keeps the order.)
#[inline(always)]
pub(crate) fn next_length<L: Lane>(h: L, error: L) -> L {
    let factor = L::splat(0.9) / error.max(L::splat(1e-24)).sqrt().sqrt().sqrt();
    h * factor.min(L::splat(5.0)).max(L::splat(0.2))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// y = (1/(1 + t), 1 + t, ln(1 + t), sin t, cos t) solves these.
    fn rates([a, b, _, sin, cos]: &[f64; 5]) -> [f64; 5] {
        [-a * a, a * b, a * a * b, *cos, -sin]
    }

    fn exact(t: f64) -> [f64; 5] {
        let (sin, cos) = libm::sincos(t);
        [1.0 / (1.0 + t), 1.0 + t, libm::log(1.0 + t), sin, cos]
    }

    fn one(t: f64, h: f64) -> Trial<f64, 5> {
        step(&exact(t), &rates(&exact(t)), h, 1e-3, rates)
    }

    fn largest(a: &[f64; 5], b: &[f64; 5]) -> f64 {
        let off = a.iter().zip(b).map(|(a, b)| (a - b).abs());
        off.fold(0.0, f64::max)
    }

    /// One step is wrong by O(h⁶), and by O(h⁵) between its ends: half the step leaves a 64th and a 32nd, or less where
    /// the next order counts as well.
    #[test]
    fn a_step_is_of_fifth_order_and_of_fourth_within() {
        for t in [0.1, 0.7] {
            let errors = [0.1, 0.05].map(|h| largest(&one(t, h).state, &exact(t + h)));
            let ratio = errors[0] / errors[1];
            assert!(ratio > 45.0, "{errors:?}");
            for x in [0.3, 0.8] {
                let errors = [0.1, 0.05].map(|h| {
                    let between = one(t, h).between(&exact(t), x);
                    largest(&between, &exact(t + x * h))
                });
                let ratio = errors[0] / errors[1];
                assert!(ratio > 22.0, "{x} {errors:?}");
            }
            let trial = one(t, 0.2);
            assert!(largest(&trial.between(&exact(t), 0.0), &exact(t)) < 1e-15);
            assert!(largest(&trial.between(&exact(t), 1.0), &trial.state) < 1e-15);
        }
    }

    /// The error is the difference from Dormand and Prince's solution of fourth order, over what is allowed.
    #[test]
    fn the_error_is_that_of_the_embedded_solution() {
        let (t, h) = (0.1, 0.3);
        let (start, trial) = (exact(t), one(t, h));
        let weights = [
            5_179.0 / 57_600.0,
            7_571.0 / 16_695.0,
            393.0 / 640.0,
            -92_097.0 / 339_200.0,
            187.0 / 2_100.0,
            1.0 / 40.0,
        ];
        let relative = |i: usize| {
            let stages = trial.stages.iter().zip(weights);
            let fourth = start[i] + h * stages.map(|(k, w)| w * k[i]).sum::<f64>();
            let allowed = 1e-3 * (1.0 + start[i].abs().max(trial.state[i].abs()));
            (trial.state[i] - fourth) / allowed
        };
        let mean = (0..5).map(|i| relative(i) * relative(i)).sum::<f64>() / 5.0;
        assert!((trial.error / mean - 1.0).abs() < 1e-6, "{mean} {trial:?}");
        // an even number of components, in either order
        let pair = |[a, b]: &[f64; 2]| [-a * a, a * b];
        let reversed = |[b, a]: &[f64; 2]| [a * b, -a * a];
        let [a, b, ..] = start;
        let mean = (0..2).map(|i| relative(i) * relative(i)).sum::<f64>() / 2.0;
        for even in [
            step(&[a, b], &pair(&[a, b]), h, 1e-3, pair),
            step(&[b, a], &reversed(&[b, a]), h, 1e-3, reversed),
        ] {
            assert!((even.error / mean - 1.0).abs() < 1e-6, "{mean} {even:?}");
        }
    }

    /// A step has nine tenths of the length that the error asks for, within a fifth and five times the last.
    #[test]
    fn the_next_step_is_as_long_as_the_error_allows() {
        for (error, factor) in [
            (1.0, 0.9),
            (2.0_f64.powi(8), 0.45),
            (2.0_f64.powi(-8), 1.8),
            (1e-30, 5.0),
            (1e30, 0.2),
        ] {
            assert!((next_length(0.7, error) - 0.7 * factor).abs() < 1e-15);
            assert!((shorter(0.7, error) - 0.7 * factor).abs() < 1e-15);
        }
        for error in [f64::INFINITY, f64::NAN] {
            assert!((shorter(0.7, error) - 0.14).abs() < 1e-15);
            assert!(!is_accepted(error));
        }
        assert!(is_accepted(1.0) && !is_accepted(1.0 + 1e-15));
    }
}

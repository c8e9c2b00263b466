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

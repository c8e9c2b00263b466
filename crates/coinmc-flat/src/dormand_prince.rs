//! One step of Dormand & Prince's embedded pair of order 5(4), J. Comput. Appl. Math. 6 (1980) 19,
//! with its continuous extension of order 4 (Hairer, Nørsett & Wanner, *Solving Ordinary
//! Differential Equations I*, II.6).

use coinmc_lanes::Lane;

/// y' = f(y).
pub(crate) trait System<const N: usize> {
    /// f(y).
    fn rates(&self, y: &[f64; N]) -> [f64; N];
}

/// A system whose f need not be defined everywhere.
pub(crate) trait Flow<const N: usize, L> {
    /// f(y), or `None` where it is not defined.
    fn rates(&mut self, y: &[L; N]) -> Option<[L; N]>;
}

impl<const N: usize, L, F: FnMut(&[L; N]) -> Option<[L; N]>> Flow<N, L> for F {
    #[inline(always)]
    fn rates(&mut self, y: &[L; N]) -> Option<[L; N]> {
        self(y)
    }
}

/// A completed step.
pub(crate) struct Step<const N: usize> {
    start: [f64; N],
    pub(crate) end: [f64; N],
    /// f at the end: the first stage of the next step.
    pub(crate) rates: [f64; N],
    /// Difference of the two orders.
    pub(crate) error: [f64; N],
    /// r₃, r₄, r₅ of the continuous extension.
    inner: [[f64; N]; 3],
}

impl<const N: usize> Step<N> {
    /// A step of length `h` from `y`, where f is `k1`.
    #[inline]
    pub(crate) fn take(system: &impl System<N>, y: &[f64; N], k1: &[f64; N], h: f64) -> Self {
        let stages = stages(|y: &[f64; N]| Some(system.rates(y)), y, k1, h)
            .expect("f is defined everywhere");
        let [k3, k4, k5, k6] = &stages.inner;
        let end = stages.end;
        let k7 = system.rates(&end);
        let [first, e3, e4, e5, e6] = stages.difference(k1);
        let difference = [first, e3, e4, e5, e6, (LAST_DIFFERENCE, &k7)];
        let dense = [
            (-12_715_105_075.0 / 11_282_082_432.0, k1),
            (87_487_479_700.0 / 32_700_410_799.0, k3),
            (-10_690_763_975.0 / 1_880_347_072.0, k4),
            (701_980_252_875.0 / 199_316_789_632.0, k5),
            (-1_453_857_185.0 / 822_651_844.0, k6),
            (69_997_945.0 / 29_380_423.0, &k7),
        ];
        let zero = [0.0; N];
        let r3: [f64; N] = std::array::from_fn(|i| h * k1[i] - (end[i] - y[i]));
        let r4 = std::array::from_fn(|i| (end[i] - y[i]) - h * k7[i] - r3[i]);
        Self {
            start: *y,
            end,
            rates: k7,
            error: combine(&zero, h, difference),
            inner: [r3, r4, combine(&zero, h, dense)],
        }
    }

    /// The state at a share of the step, 0 to 1.
    pub(crate) fn at(&self, share: f64) -> [f64; N] {
        let rest = 1.0 - share;
        let [r3, r4, r5] = &self.inner;
        std::array::from_fn(|i| {
            let r2 = self.end[i] - self.start[i];
            self.start[i] + share * (r2 + rest * (r3[i] + share * (r4[i] + rest * r5[i])))
        })
    }
}

/// The end of a step, and the stages from which its error is computed.
pub(crate) struct Stages<const N: usize, L = f64> {
    /// The third to the sixth; the second is used only in later stages.
    inner: [[L; N]; 4],
    /// The state at the end, of order 5.
    pub(crate) end: [L; N],
}

/// The stages of a step of length `h` from `y`, where f is `k1`; `None` if f is undefined in any.
#[inline(always)]
pub(crate) fn stages<const N: usize, L: Lane>(
    mut flow: impl Flow<N, L>,
    y: &[L; N],
    k1: &[L; N],
    h: L,
) -> Option<Stages<N, L>> {
    let k2 = flow.rates(&combine(y, h, [(0.2, k1)]))?;
    let k3 = flow.rates(&combine(y, h, [(3.0 / 40.0, k1), (9.0 / 40.0, &k2)]))?;
    let a4 = [(44.0 / 45.0, k1), (-56.0 / 15.0, &k2), (32.0 / 9.0, &k3)];
    let k4 = flow.rates(&combine(y, h, a4))?;
    let a5 = [
        (19372.0 / 6561.0, k1),
        (-25360.0 / 2187.0, &k2),
        (64448.0 / 6561.0, &k3),
        (-212.0 / 729.0, &k4),
    ];
    let k5 = flow.rates(&combine(y, h, a5))?;
    let a6 = [
        (9017.0 / 3168.0, k1),
        (-355.0 / 33.0, &k2),
        (46732.0 / 5247.0, &k3),
        (49.0 / 176.0, &k4),
        (-5103.0 / 18656.0, &k5),
    ];
    let k6 = flow.rates(&combine(y, h, a6))?;
    let order5 = [
        (35.0 / 384.0, k1),
        (500.0 / 1113.0, &k3),
        (125.0 / 192.0, &k4),
        (-2187.0 / 6784.0, &k5),
        (11.0 / 84.0, &k6),
    ];
    Some(Stages {
        end: combine(y, h, order5),
        inner: [k3, k4, k5, k6],
    })
}

/// Weight of the seventh stage, f at the end of the step, in the difference of the two orders.
pub(crate) const LAST_DIFFERENCE: f64 = -1.0 / 40.0;

impl<const N: usize, L: Lane> Stages<N, L> {
    /// The terms of the difference of the two orders, without the seventh stage.
    #[inline(always)]
    pub(crate) fn difference<'a>(&'a self, k1: &'a [L; N]) -> [(f64, &'a [L; N]); 5] {
        let [k3, k4, k5, k6] = &self.inner;
        [
            (71.0 / 57600.0, k1),
            (-71.0 / 16695.0, k3),
            (71.0 / 1920.0, k4),
            (-17253.0 / 339_200.0, k5),
            (22.0 / 525.0, k6),
        ]
    }
}

/// The factor by which the next step may be longer, `error` in units of the allowed error.
pub(crate) fn growth(error: f64) -> f64 {
    (0.9 * libm::pow(error.max(1e-30), -0.2)).clamp(0.1, 5.0)
}

/// y + h Σ weight·rates
#[inline(always)]
pub(crate) fn combine<const N: usize, const M: usize, L: Lane>(
    y: &[L; N],
    h: L,
    terms: [(f64, &[L; N]); M],
) -> [L; N] {
    let mut end = *y;
    for (i, component) in end.iter_mut().enumerate() {
        let mut sum = L::splat(0.0);
        for (weight, rates) in &terms {
            sum += L::splat(*weight) * rates[i];
        }
        *component += h * sum;
    }
    end
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A pendulum: y'' = −sin y.
    struct Pendulum;

    impl System<2> for Pendulum {
        fn rates(&self, y: &[f64; 2]) -> [f64; 2] {
            [y[1], -libm::sin(y[0])]
        }
    }

    const START: [f64; 2] = [1.0, 0.4];

    fn integrate(steps: u32) -> [f64; 2] {
        let h = 3.0 / f64::from(steps);
        (0..steps).fold(START, |y, _| {
            Step::take(&Pendulum, &y, &Pendulum.rates(&y), h).end
        })
    }

    /// Halving the step divides the error by 2⁵, its middle's by 2⁵ as well (local error of a
    /// continuous extension of order 4).
    #[test]
    fn steps_are_of_order_five_and_so_is_the_local_error_between() {
        let [a, b, c] = [16, 32, 64].map(integrate);
        let order = libm::log2((a[0] - b[0]).abs() / (b[0] - c[0]).abs());
        assert!((order - 5.0).abs() < 0.5, "{order}");
        let middle = |h: f64| {
            let whole = Step::take(&Pendulum, &START, &Pendulum.rates(&START), h);
            let half = Step::take(&Pendulum, &START, &Pendulum.rates(&START), 0.5 * h);
            (whole.at(0.5)[0] - half.end[0]).abs()
        };
        let order = libm::log2(middle(0.2) / middle(0.1));
        assert!((order - 5.0).abs() < 0.5, "{order}");
    }

    #[test]
    fn the_extension_joins_the_ends() {
        let step = Step::take(&Pendulum, &START, &Pendulum.rates(&START), 0.3);
        assert_eq!(step.at(0.0), START);
        for (at, end) in step.at(1.0).iter().zip(step.end) {
            assert!((at - end).abs() < 1e-15);
        }
    }
}

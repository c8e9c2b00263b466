//! Quantiles of the beta distribution, accurate for any number of tosses.
//!
//! Own code, because general-purpose libraries lose digits at the sample sizes of runs: their
//! continued fraction stops after a fixed number of terms and ln Γ(n) cancels, so that at n = 1e8 an
//! interval excludes its own estimate.

/// The x at which the regularised incomplete beta function I_x(a, b) equals `tail`, for a, b >= ½;
/// returned as (x, 1 − x), both to full precision.
///
/// In the variable w = ln(t/(1 − t)) the density is t^a (1 − t)^b dw: analytic, log-concave, its
/// mode at t = p = a/(a + b). With d = w − ln(a/b) and q = 1 − p,
///
/// ln(density/mode) = −a·log1p(q·expm1(−d)) − b·log1p(p·expm1(d)),
///
/// which needs no gamma function and has no large cancellation: the result is the ratio of the integral
/// up to x and the integral over the whole line.
pub(crate) fn beta_quantile(a: f64, b: f64, tail: f64) -> (f64, f64) {
    let density = LogitDensity { a, b };
    let (low, high) = (density.edge(-1.0), density.edge(1.0));
    let panel = |i: u32| low + (high - low) * f64::from(i) / f64::from(PANELS);
    let shares: Vec<f64> = (0..PANELS)
        .map(|i| density.integral(panel(i), panel(i + 1)))
        .collect();
    let mut wanted = tail * shares.iter().sum::<f64>();
    let mut index = 0;
    for share in &shares[..shares.len() - 1] {
        if wanted < *share {
            break;
        }
        wanted -= share;
        index += 1;
    }
    let start = panel(index);
    let (mut inside, mut outside) = (start, panel(index + 1));
    // 60 halvings exhaust the digits of d
    for _ in 0..60 {
        let middle = f64::midpoint(inside, outside);
        let below = density.integral(start, middle) < wanted;
        *(if below { &mut inside } else { &mut outside }) = middle;
    }
    density.probabilities(f64::midpoint(inside, outside))
}

/// Panels of the composite quadrature: each a fraction of a standard deviation (or, in a tail
/// that falls like e^d, about one e-fold) wide, so that eight nodes reach round-off.
const PANELS: u32 = 128;
/// Logarithm of the density at which either end is cut off, relative to the mode.
const CUT: f64 = -60.0;

struct LogitDensity {
    a: f64,
    b: f64,
}

impl LogitDensity {
    fn mode(&self) -> f64 {
        self.a / (self.a + self.b)
    }

    fn log(&self, d: f64) -> f64 {
        let (p, q) = (self.mode(), self.b / (self.a + self.b));
        -self.a * libm::log1p(q * libm::expm1(-d)) - self.b * libm::log1p(p * libm::expm1(d))
    }

    /// (t, 1 − t) at d.
    fn probabilities(&self, d: f64) -> (f64, f64) {
        let (p, q) = (self.mode(), self.b / (self.a + self.b));
        let odds = |p: f64, d: f64| p * libm::exp(d) / (1.0 + p * libm::expm1(d));
        (odds(p, d), odds(q, -d))
    }

    /// The point on one side at, or a little beyond, which the density has fallen to the cut-off.
    fn edge(&self, side: f64) -> f64 {
        // the standard deviation of d
        let mut d = side / (self.a * self.b / (self.a + self.b)).sqrt();
        while self.log(d) > CUT {
            d *= 1.25;
        }
        d
    }

    /// Gauss–Legendre quadrature with eight nodes.
    fn integral(&self, from: f64, to: f64) -> f64 {
        const NODES: [(f64, f64); 4] = [
            (0.183_434_642_495_649_8, 0.362_683_783_378_362),
            (0.525_532_409_916_329, 0.313_706_645_877_887_27),
            (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
            (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
        ];
        let (centre, half) = (f64::midpoint(from, to), 0.5 * (to - from));
        let sum: f64 = NODES
            .iter()
            .map(|(node, weight)| {
                let (left, right) = (centre - half * node, centre + half * node);
                weight * (libm::exp(self.log(left)) + libm::exp(self.log(right)))
            })
            .sum();
        half * sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// I_x(1, b) = 1 − (1 − x)^b and I_x(a, 1) = x^a, to 1e-9: 128 panels across 60 e-folds
    /// leave 1e-10 in tails of 1e-9, and the differences of logarithms 1e-11 at 1e10.
    #[test]
    fn power_laws_are_inverted() {
        for n in [1.0, 2.0, 7.5, 1e3, 1e6, 1e10] {
            for tail in [1e-9, 0.025, 0.5, 0.975] {
                let (first, _) = beta_quantile(1.0, n, tail);
                let exact = -libm::expm1(libm::log1p(-tail) / n);
                assert!(
                    (first / exact - 1.0).abs() < 1e-11,
                    "1, {n}, {tail}: {first} {exact}"
                );
                let (_, rest) = beta_quantile(n, 1.0, tail);
                let exact = -libm::expm1(libm::log(tail) / n);
                assert!(
                    (rest / exact - 1.0).abs() < 1e-9,
                    "{n}, 1, {tail}: {rest} {exact}"
                );
            }
        }
    }

    /// I_x(2, 2) = x²(3 − 2x), I_x(a, a) = ½ at ½.
    #[test]
    fn polynomial_and_symmetric_cases() {
        for tail in [0.001, 0.2, 0.9] {
            let (x, _) = beta_quantile(2.0, 2.0, tail);
            assert!((x * x * (3.0 - 2.0 * x) / tail - 1.0).abs() < 1e-12);
        }
        for a in [1.0, 30.0, 1e5, 1e12] {
            assert!((beta_quantile(a, a, 0.5).0 - 0.5).abs() < 1e-12, "{a}");
        }
    }

    /// Rounding leaves something over when the panels are taken off one by one; no place lies beyond the
    /// last of them. To 1e-12: both are computed from nearly the same d, to round-off.
    #[test]
    fn no_quantile_lies_beyond_the_cut_off() {
        for a in [0.5, 1.0, 3.0, 40.0, 1e3, 1e6, 1e9] {
            for b in [0.5, 1.0, 7.5, 1e3, 1e6] {
                let density = LogitDensity { a, b };
                let (_, least) = density.probabilities(density.edge(1.0));
                let (_, rest) = beta_quantile(a, b, 1.0 - f64::EPSILON / 2.0);
                assert!(rest > (1.0 - 1e-12) * least, "{a} {b}: {rest:e} {least:e}");
            }
        }
    }
}

//! The Kolmogorov–Smirnov test of one sample.

use super::SIGNIFICANCE;
use super::binomial::{Binomial, Power, least_shift};

/// Samples up to this size use the exact distribution; beyond, the corrected limit is as accurate.
const EXACT: u64 = 500;

/// D, the largest distance between the empirical distribution function of a sample and a
/// distribution function.
///
/// # Example
/// ```
/// use coinmc_robot::fairness::distance;
/// let d = distance(&mut [0.1, 0.4, 0.7], |x: f64| x);
/// assert!((d - 0.3).abs() < 1e-15);
/// ```
pub fn distance(sample: &mut [f64], cdf: impl Fn(f64) -> f64) -> f64 {
    sample.sort_by(f64::total_cmp);
    let n = sample.len() as f64;
    let at = |(index, x): (usize, &f64)| {
        let (f, i) = (cdf(*x), index as f64);
        ((i + 1.0) / n - f).max(f - i / n)
    };
    sample.iter().enumerate().map(at).fold(0.0, f64::max)
}

/// The p-value of a distance: the probability that a sample of `n` values from the distribution
/// itself has at least the distance `d`.
///
/// Up to 500 values: Marsaglia, Tsang & Wang, "Evaluating Kolmogorov's distribution", J. Stat.
/// Softw. 8 (2003) 18, accurate to 13 digits, and to 7 digits in the far tail. Beyond: the limit
/// distribution at d sqrt(n) + 1/(6 sqrt(n)) + (d sqrt(n) − 1)/(4n) (Vrbik, Pioneer J. Theor. Appl.
/// Stat. 15 (2018) 15), accurate to 1e-5.
pub fn kolmogorov_p_value(n: u64, d: f64) -> f64 {
    let root = (n as f64).sqrt();
    let s = d * d * n as f64;
    if d <= 0.0 || n == 0 {
        1.0
    } else if d >= 1.0 {
        0.0
    } else if n > EXACT {
        let x = d * root;
        limit(x + 1.0 / (6.0 * root) + (x - 1.0) / (4.0 * n as f64))
    } else if s > 7.24 || (s > 3.76 && n > 99) {
        2.0 * libm::exp(-(2.000_071 + 0.331 / root + 1.409 / n as f64) * s)
    } else {
        (1.0 - exact(n, d)).clamp(0.0, 1.0)
    }
}

/// 2 Σ (−1)^(j−1) exp(−2 j² x²), or its theta transform where that converges faster.
fn limit(x: f64) -> f64 {
    use std::f64::consts::PI;
    if x < 1.0 {
        let term = |j: i32| {
            let odd = f64::from(2 * j - 1);
            libm::exp(-odd * odd * PI * PI / (8.0 * x * x))
        };
        return 1.0 - (2.0 * PI).sqrt() / x * (1..=6).map(term).sum::<f64>();
    }
    let term = |j: i32| {
        let sign = if j % 2 == 1 { 2.0 } else { -2.0 };
        sign * libm::exp(-2.0 * f64::from(j * j) * x * x)
    };
    (1..=8).map(term).sum::<f64>().clamp(0.0, 1.0)
}

/// P(D < d) = n!/nⁿ times the middle element of Hⁿ.
fn exact(n: u64, d: f64) -> f64 {
    let nd = n as f64 * d;
    // positive, and at most n
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let k = nd as usize + 1;
    let m = 2 * k - 1;
    let h = k as f64 - nd;
    let mut matrix = Matrix::new(m, |i, j| if j > i + 1 { 0.0 } else { 1.0 });
    let power = |exponent: usize| libm::pow(h, exponent as f64);
    for i in 0..m {
        *matrix.at(i, 0) -= power(i + 1);
        *matrix.at(m - 1, i) -= power(m - i);
    }
    if 2.0 * h - 1.0 > 0.0 {
        *matrix.at(m - 1, 0) += libm::pow(2.0 * h - 1.0, m as f64);
    }
    for i in 0..m {
        for j in 0..m.min(i + 1) {
            for divisor in 1..=i - j + 1 {
                *matrix.at(i, j) /= divisor as f64;
            }
        }
    }
    let (mut result, mut exponent) = matrix.power(n);
    let mut value = *result.at(k - 1, k - 1);
    for i in 1..=n {
        value *= i as f64 / n as f64;
        if value < 1e-140 {
            (value, exponent) = (value * 1e140, exponent - 140);
        }
    }
    value * libm::pow(10.0, f64::from(exponent))
}

/// A square matrix.
#[derive(Clone)]
struct Matrix {
    m: usize,
    elements: Vec<f64>,
}

impl Matrix {
    fn new(m: usize, element: impl Fn(usize, usize) -> f64) -> Self {
        let elements = (0..m * m).map(|at| element(at / m, at % m)).collect();
        Self { m, elements }
    }

    fn at(&mut self, i: usize, j: usize) -> &mut f64 {
        &mut self.elements[i * self.m + j]
    }

    fn times(&self, other: &Self) -> Self {
        let m = self.m;
        let mut product = Self::new(m, |_, _| 0.0);
        for i in 0..m {
            for k in 0..m {
                let factor = self.elements[i * m + k];
                let row = &other.elements[k * m..(k + 1) * m];
                let into = &mut product.elements[i * m..(i + 1) * m];
                into.iter_mut()
                    .zip(row)
                    .for_each(|(sum, x)| *sum += factor * x);
            }
        }
        product
    }

    /// The n-th power, as a matrix and a power of ten to multiply it by.
    fn power(&self, n: u64) -> (Self, i32) {
        let mut result = Self::new(self.m, |i, j| if i == j { 1.0 } else { 0.0 });
        let (mut result_ten, mut square, mut square_ten) = (0, self.clone(), 0);
        let mut left = n;
        while left > 0 {
            if left % 2 == 1 {
                result = result.times(&square);
                result_ten += square_ten + result.rescale();
            }
            square = square.times(&square);
            square_ten = 2 * square_ten + square.rescale();
            left /= 2;
        }
        (result, result_ten)
    }

    /// Divides by 10^140 if the middle element exceeds it; returns the exponent.
    fn rescale(&mut self) -> i32 {
        let middle = self.m / 2;
        if *self.at(middle, middle) < 1e140 {
            return 0;
        }
        self.elements.iter_mut().for_each(|x| *x *= 1e-140);
        140
    }
}

/// An upper bound on the smallest distance between a distribution and the one tested that the test
/// detects: where the two are furthest apart, the sample's fraction is binomial, and it suffices
/// that this fraction exceeds the critical distance; a fraction near a half varies most.
pub(super) fn power(n: u64) -> Power {
    let critical = least_shift(1.0, |d| kolmogorov_p_value(n, d) <= SIGNIFICANCE);
    // positive, and at most 2 n
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let beyond = (n as f64 * (0.5 + critical)).floor() as u64 + 1;
    let least = |power: f64| {
        least_shift(0.5, |shift| {
            Binomial::new(n, 0.5 + shift).at_least(beyond) >= power
        })
    };
    Power {
        at_80: least(0.8),
        at_95: least(0.95),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn p_values_match_scipy() {
        for (n, d, value, tolerance) in SCIPY {
            let ours = kolmogorov_p_value(n, d);
            assert!((ours / value - 1.0).abs() < tolerance, "{n}, {d}: {ours}");
        }
    }

    /// scipy 1.17: scipy.stats.kstwo.sf(d, n), which beyond n = 140 is an expansion itself.
    const SCIPY: [(u64, f64, f64, f64); 9] = [
        (10, 0.274, 0.371_520_384_543_495_7, 1e-12),
        (10, 0.5, 0.007_777_41, 1e-12),
        (100, 0.05, 0.953_215_971_063_572_5, 1e-12),
        (100, 0.1358, 0.045_359_802_733_613_31, 1e-12),
        (100, 0.2, 0.000_555_192_732_798_877_5, 1e-3),
        (500, 0.03, 0.747_316_670_045_702_1, 1e-6),
        (500, 0.06, 0.052_434_634_890_262_23, 1e-6),
        (1000, 0.0429, 0.048_948_410_998_157_72, 1e-3),
        (20_000, 0.0096, 0.049_801_860_545_802_49, 1e-4),
    ];

    #[test]
    fn the_two_methods_agree_where_they_meet() {
        for d in [0.02, 0.04, 0.06, 0.08] {
            let (below, above) = (
                kolmogorov_p_value(EXACT, d),
                kolmogorov_p_value(EXACT + 1, d),
            );
            assert!((below - above).abs() < 3e-3, "{d}: {below} {above}");
        }
    }

    #[test]
    fn power_grows_with_the_sample() {
        let (few, many) = (power(100), power(1000));
        assert!(many.at_80 < few.at_80 && few.at_80 < few.at_95);
        // 1.358/sqrt(1000) = 0.043 is critical, and the share varies by 0.016
        assert!((many.at_80 - 0.056).abs() < 0.003, "{many:?}");
    }
}

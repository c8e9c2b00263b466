//! The exact binomial test and its power.

/// The distribution of the number of successes in n trials of probability p.
///
/// Probabilities are computed from the ratios of neighbours, outwards from the mode, and divided by
/// their sum, which avoids gamma functions and cancellation.
///
/// # Example
/// ```
/// use coinmc_robot::fairness::Binomial;
/// let fair = Binomial::new(10, 0.5);
/// assert!((fair.two_sided_p_value(8) - 112.0 / 1024.0).abs() < 1e-15);
/// ```
#[derive(Debug, Clone)]
pub struct Binomial {
    /// Number of successes for the first probability.
    first: u64,
    probabilities: Vec<f64>,
}

/// Relative probability below which a tail is cut.
const CUT: f64 = 1e-30;

/// Probabilities within this factor count as equal, because of rounding.
const SAME: f64 = 1.0 + 1e-7;

/// The smallest bias that a test detects.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Power {
    /// With a probability of 80 %.
    pub at_80: f64,
    /// With a probability of 95 %.
    pub at_95: f64,
}

impl Binomial {
    /// The distribution; `p` from 0 to 1.
    pub fn new(n: u64, p: f64) -> Self {
        // from 0 to n
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let mode = ((n as f64 + 1.0) * p).min(n as f64) as u64;
        let odds = p / (1.0 - p);
        let (mut up, mut down) = (vec![1.0], Vec::new());
        for k in mode..n {
            let next = up[up.len() - 1] * ((n - k) as f64 / (k + 1) as f64) * odds;
            if next < CUT {
                break;
            }
            up.push(next);
        }
        let mut last = 1.0;
        for k in (1..=mode).rev() {
            last *= k as f64 / (n - k + 1) as f64 / odds;
            if last < CUT {
                break;
            }
            down.push(last);
        }
        let first = mode - down.len() as u64;
        let mut probabilities: Vec<f64> = down.into_iter().rev().chain(up).collect();
        // sum from the small ends inwards
        let sum: f64 = sum(&probabilities);
        for value in &mut probabilities {
            *value /= sum;
        }
        Self {
            first,
            probabilities,
        }
    }

    /// Probability of `k` successes (0 if it is below 1e-30 of the largest).
    pub fn probability(&self, k: u64) -> f64 {
        k.checked_sub(self.first)
            .and_then(|index| self.probabilities.get(usize::try_from(index).ok()?))
            .copied()
            .unwrap_or(0.0)
    }

    /// Probability of at least `k` successes.
    pub fn at_least(&self, k: u64) -> f64 {
        let skip = usize::try_from(k.saturating_sub(self.first)).unwrap_or(usize::MAX);
        sum(self.probabilities.get(skip..).unwrap_or(&[])).min(1.0)
    }

    /// Two-sided p-value: the probability of all outcomes that are at max as probable as `k`.
    pub fn two_sided_p_value(&self, k: u64) -> f64 {
        let limit = self.probability(k) * SAME;
        let tails: Vec<f64> = self
            .probabilities
            .iter()
            .copied()
            .filter(|p| *p <= limit)
            .collect();
        sum(&tails).min(1.0)
    }

    /// The range of counts (first, last) that the two-sided test accepts at this significance.
    fn accepted(&self, significance: f64) -> (u64, u64) {
        let p = &self.probabilities;
        let (mut low, mut high, mut rejected) = (0, p.len() - 1, 0.0);
        while low < high {
            let (a, b) = (p[low], p[high]);
            // reject both ends together if they are equally probable
            let (step, more) = if a > b * SAME {
                ((0, 1), b)
            } else if b > a * SAME {
                ((1, 0), a)
            } else {
                ((1, 1), a + b)
            };
            if rejected + more > significance {
                break;
            }
            rejected += more;
            low += step.0;
            high -= step.1;
        }
        (self.first + low as u64, self.first + high as u64)
    }

    /// The smallest distance from `p`, on the less sensitive side, that the two-sided test of `n`
    /// trials against `p` detects at this significance.
    pub fn power(n: u64, p: f64, significance: f64) -> Power {
        let accepted = Self::new(n, p).accepted(significance);
        let least = |power: f64| {
            let up = least_shift(1.0 - p, |shift| reveals(n, p + shift, accepted) >= power);
            let down = least_shift(p, |shift| reveals(n, p - shift, accepted) >= power);
            up.max(down)
        };
        Power {
            at_80: least(0.8),
            at_95: least(0.95),
        }
    }
}

/// Probability of a count outside the accepted range.
fn reveals(n: u64, p: f64, (from, to): (u64, u64)) -> f64 {
    let binomial = Binomial::new(n, p.clamp(0.0, 1.0));
    1.0 - binomial.at_least(from) + binomial.at_least(to + 1)
}

/// The smallest shift up to `max` for which a condition holds; infinite if it never does.
pub(super) fn least_shift(max: f64, is_enough: impl Fn(f64) -> bool) -> f64 {
    if !is_enough(max) {
        return f64::INFINITY;
    }
    let (mut not, mut enough) = (0.0, max);
    for _ in 0..40 {
        let middle = f64::midpoint(not, enough);
        *(if is_enough(middle) {
            &mut enough
        } else {
            &mut not
        }) = middle;
    }
    enough
}

/// Sums from both ends inwards, so that small values are not lost.
fn sum(values: &[f64]) -> f64 {
    let half = values.len() / 2;
    // from 0, as the sum of nothing would be −0
    0.0 + values[..half].iter().sum::<f64>() + values[half..].iter().rev().sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::super::SIGNIFICANCE;
    use super::*;

    #[test]
    fn p_values_match_scipy() {
        // scipy 1.17: scipy.stats.binomtest(k, n, p).pvalue
        for (k, n, p, value) in [
            (5067, 10_000, 0.5, 0.183_515_463_762_703_2),
            (203, 1000, 1.0 / 6.0, 0.002_569_350_268_441_723_5),
            (3, 20, 0.25, 0.439_374_100_063_105_3),
            (540, 1000, 0.5, 0.012_444_146_277_171_8),
        ] {
            let ours = Binomial::new(n, p).two_sided_p_value(k);
            assert!((ours / value - 1.0).abs() < 1e-9, "{k} of {n}: {ours}");
        }
    }

    #[test]
    fn certain_outcomes_and_large_numbers() {
        assert_eq!(Binomial::new(7, 0.0).probability(0), 1.0);
        assert_eq!(Binomial::new(7, 1.0).probability(7), 1.0);
        let many = Binomial::new(10_000_000, 0.5);
        assert!(many.two_sided_p_value(0).is_sign_positive());
        assert!((many.at_least(5_000_000) - 0.500_126).abs() < 1e-6);
        assert!((many.at_least(0) - 1.0).abs() < 1e-12);
        assert_eq!(Binomial::new(0, 0.5).two_sided_p_value(0), 1.0);
    }

    #[test]
    fn a_thousand_throws_detect_a_bias_of_four_to_six_per_cent() {
        let power = Binomial::power(1000, 0.5, SIGNIFICANCE);
        // normal theory: (1.960 + 0.842)/(2 sqrt(1000)) = 0.0443, (1.960 + 1.645)/… = 0.0570
        assert!((power.at_80 - 0.0443).abs() < 0.0015, "{power:?}");
        assert!((power.at_95 - 0.0570).abs() < 0.0015, "{power:?}");
        // too few to detect anything: even 4 heads of 4 have p = 1/8
        assert_eq!(Binomial::power(4, 0.5, SIGNIFICANCE).at_80, f64::INFINITY);
    }

    #[test]
    fn the_type_i_error_is_at_most_the_significance() {
        for (n, p) in [(17, 0.5), (100, 1.0 / 6.0), (1000, 0.5), (999, 2.0 / 3.0)] {
            let binomial = Binomial::new(n, p);
            let error = reveals(n, p, binomial.accepted(SIGNIFICANCE));
            assert!(error <= SIGNIFICANCE + 1e-12, "{n}, {p}: {error}");
            let (from, to) = binomial.accepted(SIGNIFICANCE);
            for k in [from, to] {
                assert!(binomial.two_sided_p_value(k) > SIGNIFICANCE);
            }
            for k in [from - 1, to + 1] {
                assert!(binomial.two_sided_p_value(k) <= SIGNIFICANCE);
            }
        }
    }
}

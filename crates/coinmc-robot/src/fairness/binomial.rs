//! The exact binomial test and its power.

/// How many successes n trials of probability p give.
///
/// Probabilities come from the ratios of neighbours, outwards from the mode, and are divided by
/// their sum: no gamma function, nothing that cancels.
///
/// # Example
/// ```
/// use coinmc_robot::fairness::Binomial;
/// let fair = Binomial::new(10, 0.5);
/// assert!((fair.two_sided_p_value(8) - 112.0 / 1024.0).abs() < 1e-15);
/// ```
#[derive(Debug, Clone)]
pub struct Binomial {
    /// Number of successes of the first probability.
    first: u64,
    probabilities: Vec<f64>,
}

/// Relative probability below which a tail is cut.
const CUT: f64 = 1e-30;

/// Two probabilities this close are the same: what rounding makes of symmetry.
const SAME: f64 = 1.0 + 1e-7;

/// The smallest bias that a test reveals.
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
        // from the small ends inwards
        let sum: f64 = sum(&probabilities);
        for value in &mut probabilities {
            *value /= sum;
        }
        Self {
            first,
            probabilities,
        }
    }

    /// Probability of `k` successes (0 where it is below 1e-30 of the largest).
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

    /// Probability of anything no more probable than `k` successes: the two-sided p-value.
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

    /// The successes that the two-sided test at this significance lets pass: from, to.
    fn accepted(&self, significance: f64) -> (u64, u64) {
        let p = &self.probabilities;
        let (mut low, mut high, mut rejected) = (0, p.len() - 1, 0.0);
        while low < high {
            let (a, b) = (p[low], p[high]);
            // both ends together where they are equally probable
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

    /// The smallest distance from `p`, to the worse side, that the two-sided test of so many trials
    /// against `p`, at this significance, reveals.
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

/// Probability of a count outside the accepted ones.
fn reveals(n: u64, p: f64, (from, to): (u64, u64)) -> f64 {
    let binomial = Binomial::new(n, p.clamp(0.0, 1.0));
    1.0 - binomial.at_least(from) + binomial.at_least(to + 1)
}

/// The smallest shift, up to `most`, from which on something is true; infinite if it never is.
pub(super) fn least_shift(most: f64, is_enough: impl Fn(f64) -> bool) -> f64 {
    if !is_enough(most) {
        return f64::INFINITY;
    }
    let (mut not, mut enough) = (0.0, most);
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

/// Adds from both ends inwards, so that small ones are not lost in large ones.
fn sum(values: &[f64]) -> f64 {
    let half = values.len() / 2;
    values[..half].iter().sum::<f64>() + values[half..].iter().rev().sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::super::SIGNIFICANCE;
    use super::*;

    #[test]
    fn p_values_are_those_of_another_implementation() {
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
    fn sure_things_and_large_numbers() {
        assert_eq!(Binomial::new(7, 0.0).probability(0), 1.0);
        assert_eq!(Binomial::new(7, 1.0).probability(7), 1.0);
        let many = Binomial::new(10_000_000, 0.5);
        assert!((many.at_least(5_000_000) - 0.500_126).abs() < 1e-6);
        assert!((many.at_least(0) - 1.0).abs() < 1e-12);
        assert_eq!(Binomial::new(0, 0.5).two_sided_p_value(0), 1.0);
    }

    #[test]
    fn a_thousand_throws_reveal_a_bias_of_four_to_six_per_cent() {
        let power = Binomial::power(1000, 0.5, SIGNIFICANCE);
        // normal theory: (1.960 + 0.842)/(2 sqrt(1000)) = 0.0443, (1.960 + 1.645)/… = 0.0570
        assert!((power.at_80 - 0.0443).abs() < 0.0015, "{power:?}");
        assert!((power.at_95 - 0.0570).abs() < 0.0015, "{power:?}");
        // too few to reveal anything: even 4 heads of 4 have p = 1/8
        assert_eq!(Binomial::power(4, 0.5, SIGNIFICANCE).at_80, f64::INFINITY);
    }

    #[test]
    fn the_test_errs_no_more_often_than_it_says() {
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

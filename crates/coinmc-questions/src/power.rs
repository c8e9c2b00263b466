//! How many tosses tell an unfair coin from a fair one: the power of the χ² test.

use libm::{exp, log};

/// A test of a three-sided coin: χ² of the counts of heads, tails and side against probabilities
/// that are given.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Test {
    /// Probability of rejecting a coin that has these probabilities.
    pub false_alarm: f64,
    /// Probability of rejecting one that has not.
    pub power: f64,
}

/// Tosses after which the χ² test of `fair` (probabilities of heads, tails and side) rejects a coin
/// with the probabilities `real` with the power asked for.
///
/// χ² of n tosses has two degrees of freedom and the noncentrality n w², w² = Σ (q − p)²/p (Cohen,
/// *Statistical Power Analysis*, 1988, ch. 7). The test rejects beyond −2 ln α; the noncentral
/// distribution is a Poisson mixture of central ones with 2, 4, 6, … degrees of freedom.
///
/// # Panics
/// Unless the probabilities of `fair` and both of the test are above 0 and below 1, and `real` differs
/// from `fair`.
///
/// # Example
/// ```
/// use coinmc_questions::{Test, tosses_for_power};
/// let third = 1.0 / 3.0;
/// let test = Test { false_alarm: 0.05, power: 0.8 };
/// let real = [third - 0.025, third - 0.025, third + 0.05];
/// assert_eq!(tosses_for_power([third; 3], real, test), 857);
/// ```
pub fn tosses_for_power(fair: [f64; 3], real: [f64; 3], test: Test) -> u64 {
    let inside = |p: f64| p > 0.0 && p < 1.0;
    assert!(fair.into_iter().all(inside) && inside(test.false_alarm) && inside(test.power));
    let effect: f64 = fair
        .iter()
        .zip(real)
        .map(|(p, q)| (q - p) * (q - p) / p)
        .sum();
    assert!(effect > 0.0, "the two coins are the same");
    let limit = -2.0 * log(test.false_alarm);
    let (mut low, mut high) = (0.0, 1.0);
    while beyond(limit, high) < test.power {
        (low, high) = (high, 2.0 * high);
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if beyond(limit, middle) < test.power {
            low = middle;
        } else {
            high = middle;
        }
    }
    // a count of tosses; `as` saturates
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let tosses = libm::ceil(high / effect) as u64;
    tosses
}

/// Probability that the noncentral χ² with two degrees of freedom exceeds `limit`.
fn beyond(limit: f64, noncentrality: f64) -> f64 {
    let (x, mean) = (0.5 * limit, 0.5 * noncentrality);
    // Poisson weight of j; that of k in the upper tail of a χ² with 2(j + 1) degrees, e^-x Σ x^k/k!
    let (mut weight, mut term, mut tail) = (exp(-mean), exp(-x), exp(-x));
    let (mut sum, mut left) = (0.0, 1.0);
    for j in 1..2000 {
        sum += weight * tail;
        left -= weight;
        if left < 1e-13 && f64::from(j) > mean {
            break;
        }
        weight *= mean / f64::from(j);
        term *= x / f64::from(j);
        tail += term;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Noncentralities for two degrees of freedom and a false alarm of 5 %, from tables (Cohen 1988,
    /// and `scipy.stats.ncx2`).
    #[test]
    fn the_noncentrality_is_that_of_tables() {
        let limit = -2.0 * log(0.05);
        assert!((limit - 5.991_464_547).abs() < 1e-8);
        for (power, noncentrality) in [(0.8, 9.634_69), (0.9, 12.653_9), (0.5, 4.957_1)] {
            assert!(
                (beyond(limit, noncentrality) - power).abs() < 2e-4,
                "{power}"
            );
        }
        assert!((beyond(limit, 0.0) - 0.05).abs() < 1e-12);
    }

    /// Half the difference takes four times the tosses.
    #[test]
    fn tosses_grow_with_the_square_of_the_precision() {
        let third = 1.0 / 3.0;
        let test = Test {
            false_alarm: 0.05,
            power: 0.8,
        };
        let tosses = |d: f64| {
            tosses_for_power(
                [third; 3],
                [third - d / 2.0, third - d / 2.0, third + d],
                test,
            )
        };
        assert!(tosses(0.01).abs_diff(4 * tosses(0.02)) <= 4);
    }
}

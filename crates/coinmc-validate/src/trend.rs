//! Tests of points against each other.

use coinmc::results::{Results, Row};
use coinmc_core::inverse_normal_cdf;
use statrs::function::gamma::gamma_ur;

/// Share of false alarms of each test.
pub(crate) const LEVEL: f64 = 0.01;

/// How P(side) goes from the first point to the last.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Trend {
    Rises,
    Falls,
    /// The test does not see it move.
    Unseen,
}

impl Trend {
    /// By the difference of two shares in standard errors, each with the variance of its own share.
    pub(crate) fn of(results: &Results) -> Self {
        let [Some(first), Some(last)] = [results.rows.first(), results.rows.iter().next_back()]
        else {
            return Self::Unseen;
        };
        let variance = |row: &Row| {
            let (n, k) = (row.tally.tosses() as f64, row.tally.side as f64);
            // one toss more of either kind, so that a share of 0 has an error
            let p = (k + 1.0) / (n + 2.0);
            p * (1.0 - p) / n
        };
        let z = (last.side.p - first.side.p) / (variance(first) + variance(last)).sqrt();
        let critical = -inverse_normal_cdf(0.5 * LEVEL);
        if z > critical {
            Self::Rises
        } else if z < -critical {
            Self::Falls
        } else {
            Self::Unseen
        }
    }

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Rises => "rises",
            Self::Falls => "falls",
            Self::Unseen => "does not move visibly",
        }
    }
}

/// The p-value of the χ² test that P(side) is the same at all points.
pub(crate) fn p_same<'a>(rows: impl Iterator<Item = &'a Row> + Clone) -> f64 {
    let counts = |row: &Row| (row.tally.side as f64, row.tally.tosses() as f64);
    let (sides, tosses) = rows
        .clone()
        .map(counts)
        .fold((0.0, 0.0), |sum, (k, n)| (sum.0 + k, sum.1 + n));
    let p = sides / tosses;
    if !(p > 0.0 && p < 1.0) {
        return 1.0;
    }
    let chi_squared: f64 = rows
        .clone()
        .map(counts)
        .map(|(k, n)| (k - n * p) * (k - n * p) / (n * p * (1.0 - p)))
        .sum();
    let freedom = rows.count() as f64 - 1.0;
    gamma_ur(0.5 * freedom, 0.5 * chi_squared)
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc::plan::StoppedBy;
    use coinmc_core::Tally;

    fn results(sides: &[u64], tosses: u64) -> Results {
        let text = "coin.ratio = 1\nsurface = { restitution = 0.5, friction = 0.3 }\n\
                    launch.preset = 'robot'\nengine.flat = {}\nstop.tosses = 1";
        let plan = coinmc::config::parse("inline", text, &[]).expect("a plan");
        let row = |&side: &u64| {
            let tally = Tally {
                side,
                heads: tosses - side,
                ..Tally::default()
            };
            Row::new(&plan, 0, tally, StoppedBy::Tosses)
        };
        Results::new(&plan, sides.iter().map(row).collect())
    }

    /// Differences of 2.58 standard errors divide what is seen from what is not: 30 of 1000 against 60 and 50.
    #[test]
    fn a_trend_is_seen_beyond_its_error() {
        assert_eq!(Trend::of(&results(&[30, 60], 1000)), Trend::Rises);
        assert_eq!(Trend::of(&results(&[60, 99, 30], 1000)), Trend::Falls);
        assert_eq!(Trend::of(&results(&[30, 45], 1000)), Trend::Unseen);
        assert_eq!(Trend::of(&results(&[0, 0], 1000)), Trend::Unseen);
    }

    /// χ² = 20 on one degree of freedom: erfc(√10).
    #[test]
    fn the_same_share_is_tested_by_chi_squared() {
        let p = p_same(results(&[450, 550], 1000).rows.iter());
        assert!((p - 7.744e-6).abs() < 1e-8, "{p}");
        assert_eq!(p_same(results(&[0, 0], 10).rows.iter()), 1.0);
    }
}

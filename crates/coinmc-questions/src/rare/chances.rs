//! With which chance the launches of each stratum are tossed.

use super::interval::Counted;
use crate::interval::normal_quantile;

/// What drawing a launch costs, as a share of a toss: one that is not tossed is not free. Measured 1/100 to
/// 1/1000 in space.
const LAUNCH: f64 = 0.02;

/// Launches to draw, and the chance with which those of each stratum are tossed.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Chances {
    pub(super) each: Vec<f64>,
    pub(super) launches: f64,
    /// Tosses that come of that.
    pub(super) tosses: f64,
    /// What these cost.
    pub(super) work: f64,
}

/// How much brute force takes for the same standard error, by what these chances take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gain {
    /// Tosses.
    pub tosses: f64,
    /// Work: impacts, steps in sustained contact and one for each toss. It goes with the time.
    pub work: f64,
}

/// What is known of the strata.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Known {
    /// Share of the launches in each.
    pub(super) shares: Vec<f64>,
    /// Probability of the face in each.
    pub(super) ps: Vec<f64>,
    /// Mean work of a toss in each.
    pub(super) works: Vec<f64>,
}

impl Known {
    /// By tosses of each stratum. What they show is weighed against one event in as many tosses as it
    /// takes all strata together to show one, so that chance in a few tosses does not pass for a difference.
    pub(super) fn of(shares: Vec<f64>, counts: &[Counted]) -> Self {
        let strata = || {
            shares
                .iter()
                .zip(counts)
                .filter(|(_, counted)| counted.tosses > 0)
        };
        let tosses: u64 = strata().map(|(_, counted)| counted.tosses).sum();
        let seen = |(share, counted): (&f64, &Counted)| {
            share * counted.shown as f64 / counted.tosses as f64
        };
        let overall = strata()
            .map(seen)
            .sum::<f64>()
            .max(0.25 / (tosses as f64 + 0.5));
        let p = |counted: &Counted| {
            (counted.shown as f64 + 1.0) / (counted.tosses as f64 + 1.0 / overall)
        };
        let all: u64 = strata().map(|(_, counted)| counted.work).sum();
        let mean = all as f64 / (tosses as f64).max(1.0);
        let work = |counted: &Counted| (counted.work as f64 + mean) / (counted.tosses as f64 + 1.0);
        Self {
            ps: counts.iter().map(p).collect(),
            works: counts.iter().map(work).collect(),
            shares,
        }
    }

    fn p(&self) -> f64 {
        self.sum(|_, p| p)
    }

    /// Mean work of a toss by brute force.
    fn work(&self) -> f64 {
        self.sum(|h, _| self.works[h])
    }

    fn sum(&self, term: impl Fn(usize, f64) -> f64) -> f64 {
        let strata = self.shares.iter().zip(&self.ps).enumerate();
        strata.map(|(h, (share, p))| share * term(h, *p)).sum()
    }

    /// The chances with which the probability is known to a relative error with the least work.
    ///
    /// The variance of a launch is Σ W_h p_h/q_h − P² and its work c + Σ W_h q_h w_h, least for the same error with
    /// q_h ∝ √(p_h/w_h) (Neyman, J. R. Stat. Soc. 97 (1934) 558). The interval also allows for one more toss of the
    /// largest weight, so no chance may be too small. Of both, the factor and the least chance, a few are tried.
    pub(super) fn chances(&self, relative_error: f64, confidence: f64) -> Chances {
        let worth: Vec<f64> = self
            .ps
            .iter()
            .zip(&self.works)
            .map(|(p, w)| p / w)
            .collect();
        let of_some = worth
            .iter()
            .zip(&self.shares)
            .filter(|(_, share)| **share > 0.0);
        let largest = of_some.fold(0.0, |largest: f64, (worth, _)| largest.max(*worth));
        let tried = (0..=12).flat_map(|factor| (0..=12).map(move |least| (factor, least)));
        let tried = tried.map(|(factor, least)| {
            let octaves = |halves: i32| libm::exp2(-0.5 * f64::from(halves));
            let most = octaves(factor);
            let chance = |worth: &f64| most * (worth / largest).sqrt().clamp(octaves(least), 1.0);
            let each: Vec<f64> = worth.iter().map(chance).collect();
            self.at(&each, relative_error, confidence)
        });
        let work = |chances: &Chances| chances.work + LAUNCH * self.work() * chances.launches;
        let best = tried.min_by(|a, b| work(a).total_cmp(&work(b)));
        best.expect("some are tried")
    }

    /// What brute force takes for the same standard error, by what these chances take.
    pub(super) fn gain(&self, chances: &[f64]) -> Gain {
        let p = self.p();
        let variance = self.sum(|h, p| p / chances[h]) - p * p;
        let brute_force = p * (1.0 - p) / variance;
        Gain {
            tosses: brute_force / self.sum(|h, _| chances[h]),
            work: brute_force * self.work() / self.sum(|h, _| chances[h] * self.works[h]),
        }
    }

    /// Launches and tosses that are needed with these chances: the number N of launches after which the
    /// interval (w + z √(v + w²) + z √v)/2 is as short as asked for, by the variance v ∝ 1/N and the largest
    /// weight w = 1/(q N).
    fn at(&self, chances: &[f64], relative_error: f64, confidence: f64) -> Chances {
        let p = self.p();
        let z = normal_quantile(confidence);
        let variance = self.sum(|h, p| p / chances[h]) - p * p;
        let weight = chances.iter().copied().fold(1.0, f64::min).recip();
        let half_width = |n: f64| {
            let (v, w) = (variance / n, weight / n);
            0.5 * (w + z * (v + w * w).sqrt() + z * v.sqrt())
        };
        let [mut few, mut many] = [1.0, 1e30_f64];
        while many > 1.001 * few {
            let middle = (few * many).sqrt();
            if half_width(middle) > relative_error * p {
                few = middle;
            } else {
                many = middle;
            }
        }
        Chances {
            each: chances.to_vec(),
            launches: many,
            tosses: many * self.sum(|h, _| chances[h]),
            work: many * self.sum(|h, _| chances[h] * self.works[h]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where the stratum does not matter every launch is tossed: somewhat more than the 1.96²/(.1²) (1 − P)/P =
    /// 38,000 of them that brute force takes, since one more toss of the face is allowed for.
    #[test]
    fn where_nothing_decides_all_are_tossed() {
        let known = Known {
            shares: vec![0.25; 4],
            ps: vec![0.01; 4],
            works: vec![3.0; 4],
        };
        let chances = known.chances(0.1, 0.95);
        assert_eq!(chances.each, [1.0; 4]);
        assert!(
            (38_000.0..40_000.0).contains(&chances.tosses),
            "{}",
            chances.tosses
        );
    }

    /// The face comes only of a hundredth of the launches: 100 times fewer tosses would do, but for those that
    /// guard against surprises in the rest.
    #[test]
    fn where_the_stratum_decides_few_are_tossed() {
        let known = Known {
            shares: vec![0.01, 0.99],
            ps: vec![0.1, 1e-6],
            works: vec![3.0; 2],
        };
        let chances = known.chances(0.1, 0.95);
        assert!(chances.each[0] > 4.0 * chances.each[1], "{chances:?}");
        let p = 0.01 * 0.1 + 0.99e-6;
        let brute_force = 1.96 * 1.96 / (0.1 * 0.1) * (1.0 - p) / p;
        let gain = brute_force / chances.tosses;
        assert!((5.0..50.0).contains(&gain), "{gain} {chances:?}");
    }

    /// The launches that matter cost as much more as they show the face more often: nothing is gained in work,
    /// and a detour through few, dear tosses is not taken.
    #[test]
    fn dear_tosses_are_not_preferred() {
        let known = Known {
            shares: vec![0.01, 0.99],
            ps: vec![0.1, 1e-3],
            works: vec![100.0, 1.0],
        };
        let chances = known.chances(0.1, 0.95);
        let gain = known.gain(&chances.each);
        assert!(
            (chances.each[0] / chances.each[1] - 1.0).abs() < 1e-9,
            "{chances:?}"
        );
        assert!((0.99..1.01).contains(&gain.work), "{gain:?}");
    }
}

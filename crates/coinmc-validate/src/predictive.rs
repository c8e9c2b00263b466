//! What a prior predicts of a count or a value, and how surprising what was seen is.
//!
//! # Method
//! Each of M draws from the prior gives a probability P_j, known only by the k_j of its n_j tosses. The P_j of all
//! draws are taken as spread by a beta distribution whose mean and variance are those of the k_j/n_j less what
//! the chance of the tosses adds to the variance (the tosses would be counted twice otherwise); with its own
//! counts that gives each P_j a beta posterior. As n_j grows its own counts outweigh that shape. A scene without a
//! prior, M = 1, has Jeffreys' Beta(k + ½, n − k + ½). So a count of n tosses has the beta-binomial distribution
//! there, and the binomial one where P_j is known exactly. The predictive distribution is the mean of the M. It
//! holds the spread of the prior, the error of our own tosses and that of the count; all tails are exact sums.
//! With F and G the probabilities of no more and of no less than what was seen,
//!
//! ```text
//! p = min(1, 2 min(F, G)),    its standard error 2 sd_j(F_j)/√M
//! ```
//!
//! the error being that of M draws instead of all. A published value instead of a count is compared with the
//! distribution of P itself; a published fair ratio x ± d with that of P at x − d and x + d: the fair ratio lies
//! above x − d where P(x − d) is below the target.

use libm::{exp, log};
use statrs::function::beta::beta_reg;

/// What one draw says of a probability.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Model {
    /// It is this.
    Known(f64),
    /// It was tossed.
    Counted {
        /// Tosses that showed the face.
        shown: u64,
        /// Tosses with a face.
        tosses: u64,
    },
}

/// How the probabilities of all draws are spread: Beta(a, b).
#[derive(Debug, Clone, Copy, PartialEq)]
struct Spread([f64; 2]);

impl Spread {
    /// Jeffreys', for what nothing is known of.
    const UNKNOWN: Self = Self([0.5, 0.5]);
    /// More pseudo-counts than this are not told apart.
    const MOST: f64 = 1e6;

    /// By mean and variance of the shares, less the variance that the chance of the tosses adds.
    fn of<'a>(models: impl Iterator<Item = &'a Model> + Clone) -> Self {
        let counted = models.filter_map(|model| match *model {
            Model::Counted { shown, tosses } if tosses > 1 => {
                Some((shown as f64 / tosses as f64, tosses as f64))
            }
            _ => None,
        });
        let draws = counted.clone().count() as f64;
        let mean = counted.clone().map(|(p, _)| p).sum::<f64>() / draws;
        if draws < 2.0 || mean <= 0.0 || mean >= 1.0 {
            return Self::UNKNOWN;
        }
        let squares = counted.clone().map(|(p, _)| (p - mean) * (p - mean));
        let chance = counted.map(|(p, n)| p * (1.0 - p) / (n - 1.0));
        let variance = squares.sum::<f64>() / (draws - 1.0) - chance.sum::<f64>() / draws;
        let largest = mean * (1.0 - mean);
        // no spread at all is as many pseudo-counts as any
        let pseudo_counts = (largest / variance.max(largest / Self::MOST) - 1.0).max(1e-3);
        Self([mean * pseudo_counts, (1.0 - mean) * pseudo_counts])
    }

    /// a and b of the posterior of a draw with these counts.
    fn posterior(self, shown: u64, tosses: u64) -> [f64; 2] {
        let Self([a, b]) = self;
        [a + shown as f64, b + (tosses - shown) as f64]
    }
}

/// The probabilities of no more and of no less than what was seen.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Tails {
    no_more: f64,
    no_less: f64,
}

/// A p-value and its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Surprise {
    pub(crate) p_value: f64,
    pub(crate) error: f64,
}

impl Model {
    /// The probability, or its best estimate.
    pub(crate) fn p(&self) -> f64 {
        match *self {
            Self::Known(p) => p,
            Self::Counted { shown, tosses } => shown as f64 / tosses as f64,
        }
    }

    /// Tosses that it rests on.
    pub(crate) fn tosses(&self) -> u64 {
        match *self {
            Self::Known(_) => 0,
            Self::Counted { tosses, .. } => tosses,
        }
    }

    /// Of a count of `shown` in `tosses`.
    fn of_count(&self, spread: Spread, shown: u64, tosses: u64) -> Tails {
        let n = tosses as f64;
        match *self {
            Self::Known(p) => {
                let odds = p.clamp(1e-300, 1.0 - 1e-16);
                let odds = odds / (1.0 - odds);
                tails(shown, tosses, |k| (n - k) / (k + 1.0) * odds)
            }
            Self::Counted {
                shown: k,
                tosses: m,
            } => {
                let [a, b] = spread.posterior(k, m);
                tails(shown, tosses, |k| {
                    (n - k) / (k + 1.0) * (a + k) / (b + n - k - 1.0)
                })
            }
        }
    }

    /// The probability that P is no more than this.
    fn no_more_than(&self, spread: Spread, value: f64) -> f64 {
        match *self {
            // a closed form agrees with itself to rounding
            Self::Known(p) => f64::from(u8::from(p <= value * (1.0 + 1e-9))),
            Self::Counted { shown, tosses } => {
                let [a, b] = spread.posterior(shown, tosses);
                beta_reg(a, b, value)
            }
        }
    }

    fn no_less_than(&self, spread: Spread, value: f64) -> f64 {
        match *self {
            Self::Known(p) => f64::from(u8::from(p >= value * (1.0 - 1e-9))),
            Self::Counted { .. } => 1.0 - self.no_more_than(spread, value),
        }
    }
}

/// How surprising a count is.
pub(crate) fn count(models: &[Model], shown: u64, tosses: u64) -> Surprise {
    let spread = Spread::of(models.iter());
    let tails: Vec<_> = models
        .iter()
        .map(|model| model.of_count(spread, shown, tosses))
        .collect();
    surprise(&tails)
}

/// How surprising a probability is.
pub(crate) fn value(models: &[Model], value: f64) -> Surprise {
    let spread = Spread::of(models.iter());
    let of = |model: &Model| Tails {
        no_more: model.no_more_than(spread, value),
        no_less: model.no_less_than(spread, value),
    };
    surprise(&models.iter().map(of).collect::<Vec<_>>())
}

/// How surprising a fair ratio is: for each draw the probabilities at both ends of its interval.
pub(crate) fn fair_ratio(models: &[[Model; 2]], target: f64) -> Surprise {
    let spreads = [0, 1].map(|end: usize| Spread::of(models.iter().map(|ends| &ends[end])));
    let of = |[low, high]: &[Model; 2]| Tails {
        // P rises with the ratio
        no_more: high.no_less_than(spreads[1], target),
        no_less: low.no_more_than(spreads[0], target),
    };
    surprise(&models.iter().map(of).collect::<Vec<_>>())
}

fn surprise(tails: &[Tails]) -> Surprise {
    let draws = tails.len() as f64;
    let moments = |of: fn(&Tails) -> f64| {
        let mean = tails.iter().map(of).sum::<f64>() / draws;
        let squares = tails
            .iter()
            .map(|tails| (of(tails) - mean) * (of(tails) - mean));
        (mean, squares.sum::<f64>().sqrt() / draws)
    };
    let (no_more, no_less) = (moments(|t| t.no_more), moments(|t| t.no_less));
    let (tail, error) = if no_more.0 < no_less.0 {
        no_more
    } else {
        no_less
    };
    Surprise {
        p_value: (2.0 * tail).min(1.0),
        error: 2.0 * error,
    }
}

/// The tails at `k` of a distribution over 0 to n, of which the ratio of each term to the one before is known.
fn tails(k: u64, n: u64, ratio: impl Fn(f64) -> f64) -> Tails {
    let above = ln_sum((k..n).map(|k| ratio(k as f64)));
    let below = ln_sum((0..k).rev().map(|k| 1.0 / ratio(k as f64)));
    // 1 stands for the term at k itself
    let with_own = |ln: f64| {
        let most = ln.max(0.0);
        most + log(exp(ln - most) + exp(-most))
    };
    Tails {
        no_more: 1.0 / (1.0 + exp(above - with_own(below))),
        no_less: 1.0 / (1.0 + exp(below - with_own(above))),
    }
}

/// ln(r₁ + r₁r₂ + r₁r₂r₃ + …), whatever its size.
fn ln_sum(ratios: impl Iterator<Item = f64>) -> f64 {
    /// Sums are scaled down by this before they overflow.
    const LARGE: f64 = 1e200;
    let (mut term, mut sum, mut scaled) = (1.0, 0.0, 0.0);
    for ratio in ratios {
        term *= ratio;
        sum += term;
        if sum > LARGE {
            term /= LARGE;
            sum /= LARGE;
            scaled += log(LARGE);
        }
    }
    log(sum) + scaled
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_core::{Domain, Stream, UniformSource};

    /// Of 10 tosses of a fair coin at most 2 show heads with the probability 56/1024.
    #[test]
    fn tails_of_a_known_probability_are_binomial() {
        let tails = Model::Known(0.5).of_count(Spread::UNKNOWN, 2, 10);
        assert!((tails.no_more - 56.0 / 1024.0).abs() < 1e-14);
        assert!((tails.no_less - 1013.0 / 1024.0).abs() < 1e-14);
        let two_sided = count(&[Model::Known(0.5)], 2, 10);
        assert!((two_sided.p_value - 112.0 / 1024.0).abs() < 1e-14);
        assert_eq!(two_sided.error, 0.0);
    }

    /// With no tosses of our own, Beta(½, ½): the arcsine law; of 2 tosses 0, 1 and 2 have 3/8, 1/4 and 3/8.
    #[test]
    fn tails_of_a_tossed_probability_are_beta_binomial() {
        let model = Model::Counted {
            shown: 0,
            tosses: 0,
        };
        let tails = model.of_count(Spread::UNKNOWN, 1, 2);
        assert!((tails.no_more - 0.625).abs() < 1e-14, "{tails:?}");
        assert!((tails.no_less - 0.625).abs() < 1e-14);
    }

    /// Far tails neither overflow nor vanish: 350,757 tosses, whose ends are some 1e5 logarithms below the middle.
    #[test]
    fn tails_of_many_tosses_are_numbers() {
        for shown in [0, 100, 175_000, 350_757] {
            let tails = Model::Known(0.5).of_count(Spread::UNKNOWN, shown, 350_757);
            let sum = tails.no_more + tails.no_less;
            assert!((1.0..1.01).contains(&sum), "{shown} {tails:?}");
        }
        let middle = Model::Known(0.5).of_count(Spread::UNKNOWN, 175_378, 350_757);
        assert!((middle.no_more - 0.5).abs() < 1e-6, "{middle:?}");
        // 33 standard errors below: ln P by a sum of logarithms of binomial coefficients (Python)
        let far = Model::Known(0.5).of_count(Spread::UNKNOWN, 165_610, 350_757);
        assert!((log(far.no_more) - -548.743).abs() < 1e-3, "{far:?}");
        // impossible counts
        assert_eq!(count(&[Model::Known(0.0)], 3, 10).p_value, 0.0);
        assert_eq!(count(&[Model::Known(1.0)], 10, 10).p_value, 1.0);
    }

    /// A prior that is right: of 4,000 experiments whose truth is drawn from it, each predicted by 64 other draws
    /// that were tossed 50 times, no more than 5 % have p <= 0.05 but for 3.3 standard errors (1.1 %), and not far
    /// fewer: the tosses, whose chance is as large as the spread of this prior, are not counted twice (which
    /// would leave 0.1 %), nor is the chance taken off and the rest forgotten.
    #[test]
    fn a_right_prior_is_rejected_as_often_as_stated() {
        let repeats = 4000;
        let rejected = (0..repeats).filter(|&repeat| {
            let stream = Stream::new(7, Domain::Parameters, repeat);
            let tossed = |place: u64, tosses: u64| {
                let mut dice = stream.toss(place);
                // P between 0.1 and 0.3
                let p = 0.1 + 0.2 * dice.uniform(0);
                (0..tosses)
                    .zip(1..)
                    .filter(|(_, dimension)| dice.uniform(*dimension) < p)
                    .count() as u64
            };
            let models: Vec<_> = (0..64)
                .map(|draw| Model::Counted {
                    shown: tossed(draw, 50),
                    tosses: 50,
                })
                .collect();
            count(&models, tossed(64, 100), 100).p_value <= 0.05
        });
        let rate = rejected.count() as f64 / repeats as f64;
        assert!(rate <= 0.05 + 0.0115, "{rate}");
        assert!(rate > 0.02, "{rate}");
    }

    #[test]
    fn a_value_and_a_fair_ratio_lie_in_their_distributions() {
        let models = [0.1, 0.2, 0.3, 0.4].map(Model::Known);
        assert_eq!(value(&models, 0.25).p_value, 1.0);
        assert_eq!(value(&models, 0.1).p_value, 0.5);
        assert_eq!(value(&models, 0.05).p_value, 0.0);
        // P at both ends of the interval of the ratio, for two draws
        let pair = |low: f64, high: f64| [Model::Known(low), Model::Known(high)];
        let within = [pair(0.3, 0.4), pair(0.2, 0.35)];
        assert_eq!(fair_ratio(&within, 1.0 / 3.0).p_value, 1.0);
        // both draws are fair only above the interval
        let above = [pair(0.1, 0.2), pair(0.2, 0.3)];
        assert_eq!(fair_ratio(&above, 1.0 / 3.0).p_value, 0.0);
    }
}

//! Variance-based indices from pairs of samples.

use crate::Interval;

/// Sums over pairs of samples y and z of the face's probability, each a share of `tosses` tosses.
///
/// Both have the same distribution, so both take part in its mean and variance (Janon et al., ESAIM:
/// Probability and Statistics 18 (2014) 342). The chance of the tosses adds p(1 − p)/tosses to the
/// variance of a share s, without bias estimated by s(1 − s)/(tosses − 1), and nothing to the
/// covariance of two, whose tosses differ.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    pairs: f64,
    /// y + z
    sum: f64,
    /// y z
    product: f64,
    /// y² + z²
    squares: f64,
    /// The part of y² + z² that is chance.
    noise: f64,
}

impl Sums {
    fn of([y, z]: [f64; 2], tosses: u64) -> Self {
        Self {
            pairs: 1.0,
            sum: y + z,
            product: y * z,
            squares: y * y + z * z,
            noise: (y * (1.0 - y) + z * (1.0 - z)) / (tosses - 1) as f64,
        }
    }

    /// The sums with `sign` times those of a pair.
    fn with(&self, sign: f64, other: &Self) -> Self {
        Self {
            pairs: self.pairs + sign * other.pairs,
            sum: self.sum + sign * other.sum,
            product: self.product + sign * other.product,
            squares: self.squares + sign * other.squares,
            noise: self.noise + sign * other.noise,
        }
    }

    fn mean(&self) -> f64 {
        self.sum / (2.0 * self.pairs)
    }

    fn variance(&self) -> f64 {
        (self.squares - self.noise) / (2.0 * self.pairs) - self.mean() * self.mean()
    }

    fn covariance(&self) -> f64 {
        self.product / self.pairs - self.mean() * self.mean()
    }
}

/// Pairs of samples.
pub(super) struct Pairs {
    each: Vec<Sums>,
    all: Sums,
    confidence: f64,
}

impl Pairs {
    pub(super) fn new(pairs: impl Iterator<Item = [f64; 2]>, tosses: u64, confidence: f64) -> Self {
        let each: Vec<Sums> = pairs.map(|pair| Sums::of(pair, tosses)).collect();
        let all = each
            .iter()
            .fold(Sums::default(), |all, pair| all.with(1.0, pair));
        Self {
            each,
            all,
            confidence,
        }
    }

    /// The mean of the probability.
    pub(super) fn mean(&self) -> Interval {
        self.interval(Sums::mean)
    }

    /// Its variance.
    pub(super) fn variance(&self) -> Interval {
        self.interval(Sums::variance)
    }

    /// The correlation of y and z without the chance of the tosses: the share of the variance that
    /// comes from what both have in common.
    pub(super) fn correlation(&self) -> Interval {
        self.interval(|sums| sums.covariance() / sums.variance())
    }

    /// A number of the sums, with the interval of its jackknife (Efron & Stein, Annals of Statistics 9
    /// (1981) 586): leaving out one pair after the other.
    fn interval(&self, number: impl Fn(&Sums) -> f64) -> Interval {
        let n = self.each.len() as f64;
        let without: Vec<f64> = self
            .each
            .iter()
            .map(|pair| number(&self.all.with(-1.0, pair)))
            .collect();
        let mean = without.iter().sum::<f64>() / n;
        let squares: f64 = without.iter().map(|one| (one - mean) * (one - mean)).sum();
        let error = ((n - 1.0) / n * squares).sqrt();
        Interval::normal(number(&self.all), error, self.confidence)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_core::{Domain, Stream, UniformSource};

    /// y and z share a uniform number of a third of the variance; each is the share of 16 tosses of
    /// its probability. The intervals of 99.9 % hold what is known.
    #[test]
    fn chance_is_no_part_of_the_variance() {
        const TOSSES: u64 = 16;
        let stream = Stream::new(5, Domain::Parameters, 0);
        let pair = |i| {
            let mut uniforms = stream.toss(i);
            let common = uniforms.uniform(0);
            let mut share = |own: u32| {
                let rest = uniforms.uniform(own);
                // variances 0.04/12 and 2 · 0.04/12
                let p = 0.2 + 0.2 * common + 0.2 * 2.0_f64.sqrt() * rest;
                let shown = (0..16).filter(|toss| uniforms.uniform(own + 2 + toss) < p);
                shown.count() as f64 / TOSSES as f64
            };
            [share(1), share(100)]
        };
        let pairs = Pairs::new((0..20_000).map(pair), TOSSES, 0.999);
        let holds = |interval: Interval, known: f64, width: f64| {
            assert!(
                interval.lo < known && known < interval.hi,
                "{interval:?} {known}"
            );
            assert!(interval.half_width() < width, "{interval:?}");
        };
        holds(pairs.mean(), 0.3 + 0.1 * 2.0_f64.sqrt(), 0.01);
        holds(pairs.variance(), 0.01, 1e-3);
        holds(pairs.correlation(), 1.0 / 3.0, 0.1);
    }
}

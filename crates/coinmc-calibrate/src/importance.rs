//! Weighted points of the posterior by adaptive importance sampling: no chain, no burn-in, no tuning.
//!
//! A first round draws from the prior. Each later round draws from a mixture of normals about where the
//! likelihood, at first flattened, is large, and a share from the prior; the last round does so with the
//! likelihood as it is. Weights are posterior over mixture, so the mixture only has to cover the posterior.

use crate::points::{self, Use};
use nalgebra::{DMatrix, DVector};
use std::f64::consts::TAU;

/// Points of a round on the way, and of the last.
const ROUND: u64 = 2048;
const LAST: u64 = 16_384;
/// Rounds on the way, at most; the likelihood is flattened so far that this share of a round counts.
const ROUNDS: u64 = 12;
const ENOUGH: f64 = 0.15;
/// Parts of the mixture: weight, and the factor of the covariance. The rest comes from the prior.
const PARTS: [(f64, f64); 2] = [(0.65, 1.3), (0.25, 6.0)];

/// Points with weights that add up to 1.
#[derive(Debug, Clone)]
pub(crate) struct Weighted {
    pub(crate) points: Vec<Vec<f64>>,
    pub(crate) weights: Vec<f64>,
    /// ln of the mean likelihood over the prior.
    pub(crate) log_evidence: f64,
}

impl Weighted {
    /// How many equally weighted points would be as good.
    pub(crate) fn effective(&self) -> f64 {
        1.0 / self
            .weights
            .iter()
            .map(|weight| weight * weight)
            .sum::<f64>()
    }

    /// As many points of equal weight, by systematic resampling.
    pub(crate) fn resampled(&self, draws: u64) -> Vec<Vec<f64>> {
        let mut resampled = vec![];
        let mut sum = 0.0;
        for (point, weight) in self.points.iter().zip(&self.weights) {
            sum += weight * draws as f64;
            while (resampled.len() as f64) + 0.5 < sum {
                resampled.push(point.clone());
            }
        }
        // what rounding has left
        while (resampled.len() as u64) < draws {
            resampled.extend(resampled.last().cloned().or(self.points.last().cloned()));
        }
        spread_out(&resampled)
    }
}

/// The same draws in an order in which equal ones lie apart, so that any part of them is a sample.
fn spread_out(draws: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let n = draws.len();
    // a stride without common divisor visits every draw; that of the golden section spreads them evenly
    let stride = (n * 618 / 1000..n).find(|stride| gcd(*stride, n) == 1);
    let stride = stride.unwrap_or(1);
    (0..n).map(|k| draws[k * stride % n].clone()).collect()
}

/// The greatest common divisor.
fn gcd(mut a: usize, mut b: usize) -> usize {
    while b > 0 {
        (a, b) = (b, a % b);
    }
    a
}

/// A normal distribution.
#[derive(Debug, Clone)]
struct Normal {
    mean: DVector<f64>,
    root: DMatrix<f64>,
    log_volume: f64,
}

impl Normal {
    /// Of weighted points; a direction in which they hardly spread keeps a little width.
    fn of(points: &[Vec<f64>], weights: &[f64]) -> Option<Self> {
        let d = points.first()?.len();
        let mut mean = DVector::zeros(d);
        for (point, weight) in points.iter().zip(weights) {
            mean += *weight * DVector::from_column_slice(point);
        }
        let mut covariance = DMatrix::identity(d, d) * 1e-10;
        for (point, weight) in points.iter().zip(weights) {
            let off = DVector::from_column_slice(point) - &mean;
            covariance += *weight * &off * off.transpose();
        }
        let root = covariance.cholesky()?.l();
        let log_volume = root.diagonal().iter().map(|x| libm::log(*x)).sum();
        Some(Self {
            mean,
            root,
            log_volume,
        })
    }

    fn at(&self, normal: &[f64], factor: f64) -> Vec<f64> {
        let step = &self.root * DVector::from_column_slice(normal) * factor.sqrt();
        (&self.mean + step).iter().copied().collect()
    }

    fn log_density(&self, point: &[f64], factor: f64) -> f64 {
        let off = DVector::from_column_slice(point) - &self.mean;
        let Some(standard) = self.root.solve_lower_triangular(&off) else {
            return f64::NEG_INFINITY;
        };
        let d = point.len() as f64;
        -0.5 * standard.norm_squared() / factor
            - self.log_volume
            - 0.5 * d * libm::log(factor * TAU)
    }
}

/// ln of the standard normal density.
fn log_prior(point: &[f64]) -> f64 {
    let squares: f64 = point.iter().map(|z| z * z).sum();
    -0.5 * squares - 0.5 * point.len() as f64 * libm::log(TAU)
}

/// A round: points, and ln of prior over proposal and of the likelihood at each.
struct Round {
    points: Vec<Vec<f64>>,
    log_ratio: Vec<f64>,
    log_likelihood: Vec<f64>,
}

impl Round {
    fn new(points: Vec<Vec<f64>>, log_ratio: Vec<f64>, likelihood: &dyn Fn(&[f64]) -> f64) -> Self {
        let log_likelihood = points.iter().map(|point| likelihood(point)).collect();
        Self {
            points,
            log_ratio,
            log_likelihood,
        }
    }

    /// Weights with the likelihood to a power, and ln of their mean.
    fn weights(&self, power: f64) -> (Vec<f64>, f64) {
        let logs = self.log_ratio.iter().zip(&self.log_likelihood);
        let logs: Vec<f64> = logs.map(|(ratio, like)| ratio + power * like).collect();
        let most = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let mut weights: Vec<f64> = logs.iter().map(|log| libm::exp(log - most)).collect();
        let sum: f64 = weights.iter().sum();
        for weight in &mut weights {
            *weight /= sum;
        }
        (weights, most + libm::log(sum / logs.len() as f64))
    }

    /// The greatest power, at most 1, with which enough of the points count.
    fn power(&self) -> f64 {
        let enough = |power: f64| {
            let (weights, _) = self.weights(power);
            let squares: f64 = weights.iter().map(|weight| weight * weight).sum();
            1.0 / squares >= ENOUGH * weights.len() as f64
        };
        if enough(1.0) {
            return 1.0;
        }
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..40 {
            let middle = f64::midpoint(low, high);
            *(if enough(middle) { &mut low } else { &mut high }) = middle;
        }
        low
    }

    /// Points drawn from a mixture about a normal distribution.
    fn about(
        normal: &Normal,
        (seed, round): (u64, u64),
        points: u64,
        likelihood: &dyn Fn(&[f64]) -> f64,
    ) -> Self {
        let d = normal.mean.len();
        let uniforms = points::uniform(seed, Use::Round(round), d + 1, points);
        let prior = 1.0 - PARTS.iter().map(|(weight, _)| weight).sum::<f64>();
        let place = |uniforms: Vec<f64>| {
            let scores: Vec<f64> = uniforms[1..]
                .iter()
                .map(|u| coinmc_core::inverse_normal_cdf(*u))
                .collect();
            let mut below = 0.0;
            for (weight, factor) in PARTS {
                below += weight;
                if uniforms[0] < below {
                    return normal.at(&scores, factor);
                }
            }
            scores
        };
        let points: Vec<_> = uniforms.into_iter().map(place).collect();
        let ratio = |point: &Vec<f64>| {
            let own = log_prior(point);
            let parts = PARTS.iter().map(|(weight, factor)| {
                weight * libm::exp(normal.log_density(point, *factor) - own)
            });
            -libm::log(prior + parts.sum::<f64>())
        };
        let log_ratio = points.iter().map(ratio).collect();
        Self::new(points, log_ratio, likelihood)
    }
}

/// Weighted points of the posterior of standard normal scores; `None` if the likelihood is 0 wherever it
/// was sought.
pub(crate) fn sample(
    seed: u64,
    dimensions: usize,
    likelihood: &dyn Fn(&[f64]) -> f64,
) -> Option<Weighted> {
    let first = points::normal(seed, Use::Round(0), dimensions, 2 * ROUND);
    let ratio = vec![0.0; first.len()];
    let mut round = Round::new(first, ratio, likelihood);
    let mut number = 1;
    loop {
        let power = round.power();
        let (weights, _) = round.weights(power);
        let normal = Normal::of(&round.points, &weights)?;
        let last = power >= 1.0 || number >= ROUNDS;
        let points = if last { LAST } else { ROUND };
        round = Round::about(&normal, (seed, number), points, likelihood);
        number += 1;
        if last {
            break;
        }
    }
    let (weights, log_evidence) = round.weights(1.0);
    log_evidence.is_finite().then_some(Weighted {
        points: round.points,
        weights,
        log_evidence,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A normal likelihood far narrower than the prior and off its middle: the posterior is known.
    #[test]
    fn a_normal_posterior_is_found() {
        let (at, width) = ([1.5, -2.0, 0.3, 0.0], 0.01);
        let likelihood = |z: &[f64]| {
            let squares: f64 = z.iter().zip(at).map(|(z, at)| (z - at) * (z - at)).sum();
            -0.5 * squares / (width * width)
        };
        let found = sample(1, 4, &likelihood).unwrap();
        assert!(found.effective() > 5000.0, "{}", found.effective());
        let shrink = 1.0 / (1.0 + width * width);
        for (d, at) in at.iter().enumerate() {
            let mean: f64 = found
                .points
                .iter()
                .zip(&found.weights)
                .map(|(z, w)| w * z[d])
                .sum();
            let square: f64 = found
                .points
                .iter()
                .zip(&found.weights)
                .map(|(z, w)| w * (z[d] - mean) * (z[d] - mean))
                .sum();
            assert!((mean - shrink * at).abs() < 2e-4, "{d}: {mean}");
            assert!(
                (square.sqrt() / width - 1.0).abs() < 0.03,
                "{d}: {}",
                square.sqrt()
            );
        }
        // ∫ prior · likelihood, of which every factor is normal
        let expected: f64 = at
            .iter()
            .map(|at| {
                libm::log(width)
                    - 0.5 * libm::log(1.0 + width * width)
                    - 0.5 * at * at / (1.0 + width * width)
            })
            .sum();
        assert!(
            (found.log_evidence - expected).abs() < 0.02,
            "{}",
            found.log_evidence
        );
        let draws = found.resampled(1000);
        assert_eq!(draws.len(), 1000);
        let mean: f64 = draws.iter().take(250).map(|z| z[1]).sum::<f64>() / 250.0;
        assert!((mean + 2.0).abs() < 0.003, "{mean}");
    }

    /// A bent valley: only the sum of squares of two scores is measured.
    #[test]
    fn a_bent_posterior_is_covered() {
        let likelihood = |z: &[f64]| {
            let off = (z[0] * z[0] + z[1] * z[1] - 4.0) / 0.1;
            -0.5 * off * off
        };
        let found = sample(1, 2, &likelihood).unwrap();
        assert!(found.effective() > 300.0, "{}", found.effective());
        let mean = |d: usize| -> f64 {
            found
                .points
                .iter()
                .zip(&found.weights)
                .map(|(z, w)| w * z[d])
                .sum()
        };
        // by symmetry, with a standard deviation of each score of sqrt 2
        let allowed = 4.0 * 2.0_f64.sqrt() / found.effective().sqrt();
        assert!(mean(0).abs() < allowed && mean(1).abs() < allowed);
    }
}

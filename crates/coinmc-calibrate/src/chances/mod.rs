//! The probabilities of the faces as a smooth function of the parameters, fitted to tosses.
//!
//! ln(P(heads)/P(side)) and ln(P(tails)/P(side)) are polynomials of the parameters' scores z (standard
//! deviations of the prior from its median). Their degree is that which predicts best what was left out of
//! the fit, and what is left out shows the error, too: docs/methods/calibrate.md derives it.

mod basis;
mod fit;
mod validation;

use basis::Basis;
use fit::Coefficients;
use validation::Validated;

use crate::tosses::Faces;

/// Concentration beyond which an error is no more seen in any counts.
const MOST_CONCENTRATED: f64 = 1e7;

/// Tosses at points of a design.
#[derive(Debug, Clone)]
pub(crate) struct Tossed {
    /// Coordinates of each point, about standard normal.
    pub(crate) points: Vec<Vec<f64>>,
    /// Faces counted at each.
    pub(crate) faces: Vec<Faces>,
}

/// The probabilities of the faces, with their error.
#[derive(Debug, Clone)]
pub(crate) struct Chances {
    basis: Basis,
    coefficients: Coefficients,
    /// Fits without a part of the design each, for the jackknife.
    partial: Vec<Coefficients>,
    /// Root mean square error of a probability in the design: of the fit's shape, and of its tosses.
    error: f64,
    /// That of the shape alone, by face.
    lack: [f64; 3],
    concentration: f64,
    tosses: u64,
}

impl Chances {
    /// Fits the probabilities; `None` if that fails.
    pub(crate) fn fit(tossed: &Tossed) -> Option<Self> {
        let Validated {
            basis,
            coefficients,
            partial,
            lack,
        } = validation::best(tossed)?;
        let mut chances = Self {
            basis,
            coefficients,
            partial,
            error: 0.0,
            lack: lack.by_face(),
            concentration: MOST_CONCENTRATED,
            tosses: tossed.faces.iter().flatten().sum(),
        };
        let n = tossed.points.len() as f64;
        let (mut variance, mut spread) = (0.0, 0.0);
        for point in &tossed.points {
            variance += chances
                .error_at(point)
                .map(|error| error * error)
                .iter()
                .sum::<f64>();
            spread += chances.at(point).map(|p| p * (1.0 - p)).iter().sum::<f64>();
        }
        let variance = (variance / n + lack.square).max(f64::MIN_POSITIVE);
        chances.error = (variance / 3.0).sqrt();
        chances.concentration = (spread / n / variance - 1.0).clamp(10.0, MOST_CONCENTRATED);
        Some(chances)
    }

    /// The probabilities of heads, tails and side.
    pub(crate) fn at(&self, point: &[f64]) -> [f64; 3] {
        self.basis
            .evaluate(point, |terms| self.coefficients.faces(terms))
    }

    /// The probabilities by each of the partial fits.
    pub(crate) fn partial_at(&self, point: &[f64]) -> Vec<[f64; 3]> {
        self.basis.evaluate(point, |terms| {
            self.partial.iter().map(|fit| fit.faces(terms)).collect()
        })
    }

    /// Standard errors of the probabilities by the tosses, by the jackknife.
    pub(crate) fn error_at(&self, point: &[f64]) -> [f64; 3] {
        let partial = self.partial_at(point);
        [0, 1, 2].map(|face| jackknife(partial.iter().map(|faces| faces[face])))
    }

    /// Standard errors of the probabilities by the tosses and by the fit's shape.
    pub(crate) fn whole_error_at(&self, point: &[f64]) -> [f64; 3] {
        let error = self.error_at(point);
        [0, 1, 2].map(|face| libm::hypot(error[face], self.lack[face]))
    }

    /// Root mean square error of a probability over the design.
    pub(crate) fn error(&self) -> f64 {
        self.error
    }

    /// Degree of the polynomials.
    pub(crate) fn degree(&self) -> usize {
        self.basis.degree()
    }

    /// Tosses that showed a face.
    pub(crate) fn tosses(&self) -> u64 {
        self.tosses
    }

    /// ln of the probability of counts, but for a constant: multinomial with probabilities that are
    /// uncertain by the error of the fit (Dirichlet-multinomial).
    pub(crate) fn log_likelihood(&self, point: &[f64], counts: &Faces) -> f64 {
        let faces = self.at(point);
        let of = |(count, p): (&u64, f64)| {
            let prior = (self.concentration * p).max(1e-9);
            libm::lgamma(prior + *count as f64) - libm::lgamma(prior)
        };
        counts.iter().zip(faces).map(of).sum()
    }

    /// Variance of a share of n tosses about a probability, with the error of the fit.
    pub(crate) fn variance_of_share(&self, p: f64, tosses: u64) -> f64 {
        p * (1.0 - p) / self.worth(tosses)
    }

    /// How many tosses would tell as much if the fit were exact: no more than its concentration and 1.
    pub(crate) fn worth(&self, tosses: u64) -> f64 {
        1.0 / (1.0 / tosses as f64 + 1.0 / (self.concentration + 1.0))
    }
}

/// The standard error of a number by its values without a part each.
pub(crate) fn jackknife(partial: impl Iterator<Item = f64> + Clone) -> f64 {
    let n = partial.clone().count() as f64;
    let mean = partial.clone().sum::<f64>() / n;
    let squares: f64 = partial.map(|value| (value - mean) * (value - mean)).sum();
    ((n - 1.0) / n * squares).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_core::{Domain, Stream, UniformSource, inverse_normal_cdf};

    /// A known surface, which is no polynomial of the second degree.
    fn truth(z: &[f64]) -> [f64; 3] {
        let heads = 0.4 * z[0] - 0.2 * z[1] * z[0] + 0.05 * z[0] * z[0] * z[0] + 0.5;
        let tails = heads - 0.1 * z[1];
        let weights = [libm::exp(heads), libm::exp(tails), 1.0];
        let sum: f64 = weights.iter().sum();
        weights.map(|weight| weight / sum)
    }

    fn tossed(points: u64, tosses: u64, seed: u64) -> Tossed {
        tossed_on(truth, points, tosses, seed)
    }

    fn tossed_on(truth: fn(&[f64]) -> [f64; 3], points: u64, tosses: u64, seed: u64) -> Tossed {
        let stream = Stream::new(seed, Domain::Parameters, 0);
        let design: Vec<Vec<f64>> = (0..points)
            .map(|k| {
                let mut uniforms = stream.toss(k);
                (0..2)
                    .map(|d| inverse_normal_cdf(uniforms.uniform(d)))
                    .collect()
            })
            .collect();
        let faces = design.iter().enumerate().map(|(k, z)| {
            let [heads, tails, _] = truth(z);
            let mut uniforms = stream.toss(points + k as u64);
            let mut faces = [0; 3];
            for toss in 0..tosses {
                let u = uniforms.uniform(u32::try_from(toss).unwrap());
                let face = if u < heads {
                    0
                } else {
                    usize::from(u >= heads + tails) + 1
                };
                faces[face] += 1;
            }
            faces
        });
        let faces = faces.collect();
        Tossed {
            points: design,
            faces,
        }
    }

    /// The errors found over 20 designs are those claimed, and the cubic term is seen.
    #[test]
    fn a_known_surface_is_found_within_its_own_error() {
        let (mut off, mut claimed, mut cubic) = (0.0, 0.0, 0);
        for seed in 0..20 {
            let tossed = tossed(300, 400, seed);
            let chances = Chances::fit(&tossed).unwrap();
            cubic += usize::from(chances.degree() >= 3);
            for z in &tossed.points {
                let pairs = chances.at(z).into_iter().zip(truth(z));
                let squares: f64 = pairs.map(|(p, q)| (p - q) * (p - q)).sum();
                off += squares / (3.0 * 300.0 * 20.0);
            }
            claimed += chances.error() * chances.error() / 20.0;
        }
        assert!(cubic >= 18, "{cubic} of 20");
        let ratio = (claimed / off).sqrt();
        assert!(
            (0.8..2.0).contains(&ratio),
            "claimed {}, true {}",
            claimed.sqrt(),
            off.sqrt()
        );
    }

    /// A surface on which heads and tails are alike, which no polynomial of few terms fits.
    fn alike(z: &[f64]) -> [f64; 3] {
        let heads = libm::exp(libm::sin(2.0 * z[0]) + 0.2 * z[1]);
        let sum = 2.0 * heads + 1.0;
        [heads / sum, heads / sum, 1.0 / sum]
    }

    /// Where heads and tails err alike, the side errs by both: its shape lacks ⅔ of the squares, and the others, which lack
    /// ⅙ each, state the average of ⅓.
    #[test]
    fn the_side_knows_its_own_error() {
        let lacks = (0..5).map(|seed| {
            let tossed = tossed_on(alike, 300, 1000, seed);
            Chances::fit(&tossed).unwrap().lack
        });
        let lacks: Vec<_> = lacks.filter(|[.., side]| *side > 0.0).collect();
        assert!(lacks.len() >= 2, "{lacks:?}");
        for [heads, tails, side] in lacks {
            let ratio = side / heads.max(tails);
            assert!((ratio - 2_f64.sqrt()).abs() < 0.05, "{ratio}");
        }
    }

    /// Few tosses are worth themselves; many no more than the fit is exact to: its variance is that of their shares.
    #[test]
    fn tosses_are_worth_no_more_than_the_fit() {
        let chances = Chances::fit(&tossed(300, 50, 1)).unwrap();
        assert!((chances.worth(1) - 1.0).abs() < 0.01);
        let spread: f64 = [0.3, 0.3, 0.4].map(|p| p * (1.0 - p)).iter().sum();
        let error = (spread / chances.worth(u64::MAX) / 3.0).sqrt();
        assert!(
            (error / chances.error() - 1.0).abs() < 0.1,
            "{error} {}",
            chances.error()
        );
    }

    /// Dirichlet-multinomial probabilities of all counts of 6 tosses add up to 1.
    #[test]
    fn the_likelihood_is_a_probability() {
        let chances = Chances::fit(&tossed(300, 50, 1)).unwrap();
        let (n, z) = (6_u64, [0.3, -0.2]);
        let a = chances.concentration;
        let mut sum = 0.0;
        for heads in 0..=n {
            for tails in 0..=n - heads {
                let counts = [heads, tails, n - heads - tails];
                let ways = libm::lgamma(n as f64 + 1.0)
                    - counts
                        .iter()
                        .map(|c| libm::lgamma(*c as f64 + 1.0))
                        .sum::<f64>();
                let normal = libm::lgamma(a) - libm::lgamma(a + n as f64);
                sum += libm::exp(chances.log_likelihood(&z, &counts) + ways + normal);
            }
        }
        assert!((sum - 1.0).abs() < 1e-9, "{sum}");
    }
}

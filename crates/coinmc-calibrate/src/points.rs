//! Scrambled Sobol points as standard normal numbers.

use coinmc_core::{Domain, Stream, inverse_normal_cdf};
use coinmc_quadrature::Sobol;

/// Which points: each use has a scramble of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Use {
    /// Parameters at which coins are tossed.
    Design,
    /// Parameters and ratios at which coins are tossed.
    Ratios,
    /// A round of importance sampling.
    Round(u64),
}

impl Use {
    fn number(self) -> u64 {
        match self {
            Self::Design => 0,
            Self::Ratios => 1,
            Self::Round(round) => 2 + round,
        }
    }
}

/// Points in the unit cube.
pub(crate) fn uniform(seed: u64, used: Use, dimensions: usize, points: u64) -> Vec<Vec<f64>> {
    let mut words = Stream::new(seed, Domain::Scramble, used.number()).toss(0);
    let sobol = Sobol::scrambled(dimensions, &mut words);
    let unit = |word: &u64| coinmc_core::unit_interval(*word);
    sobol
        .points(0..points)
        .map(|point| point[..dimensions].iter().map(unit).collect())
        .collect()
}

/// Points with standard normal coordinates.
pub(crate) fn normal(seed: u64, used: Use, dimensions: usize, points: u64) -> Vec<Vec<f64>> {
    let mut points = uniform(seed, used, dimensions, points);
    for coordinate in points.iter_mut().flatten() {
        *coordinate = inverse_normal_cdf(*coordinate);
    }
    points
}

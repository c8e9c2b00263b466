//! Loss functions: squares, or Huber's loss for films with outliers.

/// The loss of a residual r, in standard deviations.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Loss {
    /// Normal noise: r²/2.
    #[default]
    Square,
    /// Huber (1964): r²/2 up to 1.345 standard deviations, linear beyond. The negative logarithm of
    /// a density that is normal in the middle and has exponential tails; 95 % as efficient as
    /// squares if the noise is normal.
    Huber,
}

/// Where Huber's loss becomes linear.
const KNEE: f64 = 1.345;

impl Loss {
    /// ρ(r).
    pub(crate) fn rho(self, r: f64) -> f64 {
        match self {
            Self::Huber if r.abs() > KNEE => KNEE * (r.abs() - 0.5 * KNEE),
            _ => 0.5 * r * r,
        }
    }

    /// ψ = ρ'.
    pub(crate) fn psi(self, r: f64) -> f64 {
        match self {
            Self::Huber => r.clamp(-KNEE, KNEE),
            Self::Square => r,
        }
    }

    /// Whether ψ'(r) = 1.
    pub(crate) fn is_inner(self, r: f64) -> bool {
        self == Self::Square || r.abs() <= KNEE
    }

    /// The residual whose half square is ρ(r) and its derivative with respect to r, for least
    /// squares.
    pub(crate) fn folded(self, r: f64) -> (f64, f64) {
        if self.is_inner(r) {
            return (r, 1.0);
        }
        let folded = (2.0 * self.rho(r)).sqrt().copysign(r);
        (folded, self.psi(r) / folded)
    }

    /// ln of the integral of exp(−ρ), which normalises the density.
    pub(crate) fn log_normaliser(self) -> f64 {
        use std::f64::consts::{SQRT_2, TAU};
        let integral = match self {
            Self::Square => TAU.sqrt(),
            Self::Huber => {
                TAU.sqrt() * libm::erf(KNEE / SQRT_2) + 2.0 / KNEE * libm::exp(-0.5 * KNEE * KNEE)
            }
        };
        libm::log(integral)
    }

    /// The scale σ at which Σ ψ(r/σ)·r/σ equals `degrees`: for squares sqrt(Σr²/degrees). 0 if all
    /// residuals are 0.
    ///
    /// The left side decreases with σ, so bisection finds it.
    pub(crate) fn scale(self, residuals: &[f64], degrees: f64) -> f64 {
        let squares = residuals.iter().map(|r| r * r).sum::<f64>();
        let least_squares = (squares / degrees).sqrt();
        if self == Self::Square || squares == 0.0 {
            return least_squares;
        }
        let excess = |sigma: f64| {
            let sum = |r: &f64| self.psi(r / sigma) * (r / sigma);
            residuals.iter().map(sum).sum::<f64>() - degrees
        };
        let (mut low, mut high) = (1e-6 * least_squares, least_squares);
        for _ in 0..60 {
            let middle = f64::midpoint(low, high);
            *(if excess(middle) > 0.0 {
                &mut low
            } else {
                &mut high
            }) = middle;
        }
        f64::midpoint(low, high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_folded_residual_has_the_value_and_slope_of_the_loss() {
        for loss in [Loss::Square, Loss::Huber] {
            for r in [-7.0, -1.3, 0.0, 0.4, 1.4, 30.0] {
                let (folded, slope) = loss.folded(r);
                assert!((0.5 * folded * folded - loss.rho(r)).abs() < 1e-12);
                assert!((folded * slope - loss.psi(r)).abs() < 1e-12);
            }
        }
    }

    /// A composite trapezium over ±60 with tails below e^-80.
    #[test]
    fn the_normaliser_is_the_integral() {
        for loss in [Loss::Square, Loss::Huber] {
            let step = 1e-3;
            let sum: f64 = (-60_000..=60_000)
                .map(|i| libm::exp(-loss.rho(f64::from(i) * step)) * step)
                .sum();
            assert!((libm::log(sum) - loss.log_normaliser()).abs() < 1e-6);
        }
    }

    /// Σψ·r/σ = n with two points of 50 and 80 among 200 of variance .37: 202 σ² = 73 + 1.345·130
    /// σ, σ = 1.17, twice the value without them; least squares gives eleven times.
    #[test]
    fn a_few_outliers_affect_hubers_scale_far_less_than_that_of_squares() {
        let mut residuals: Vec<f64> = (0..200).map(|i| f64::from(i % 21 - 10) / 10.0).collect();
        let clean = Loss::Huber.scale(&residuals, 200.0);
        residuals.extend([50.0, -80.0]);
        let wild = Loss::Huber.scale(&residuals, 202.0);
        assert!(wild / clean < 2.1 && Loss::Square.scale(&residuals, 202.0) > 10.0 * clean);
    }

    /// Ten times as large residuals have ten times the scale, however small they are.
    #[test]
    fn the_scale_has_the_unit_of_the_residuals() {
        assert_eq!(Loss::Square.scale(&[3.0, -4.0], 1.0), 5.0);
        assert_eq!(Loss::Huber.scale(&[0.0, 0.0], 1.0), 0.0);
        let residuals = [0.5, -1.0, 2.0, -0.25, 9.0];
        let unit = Loss::Huber.scale(&residuals, 4.0);
        assert!(unit > 0.5 && unit < Loss::Square.scale(&residuals, 4.0));
        for factor in [1e-9, 1e9] {
            let scale = Loss::Huber.scale(&residuals.map(|r| factor * r), 4.0);
            assert!((scale / (factor * unit) - 1.0).abs() < 1e-12, "{scale:e}");
        }
    }
}

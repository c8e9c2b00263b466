//! How the pitch of a whirring coin (Euler's disk) rises: f⁻³ falls linearly with time.

use super::readings::{error, readings};
use super::{Kind, Law, Reduce, Reduced};
use crate::Parameter;
use coinmc_core::Scene;
use coinmc_core::schema::{Bounds, ReadError, TableKind, Values, fields};
use std::f64::consts::TAU;

/// Frequencies at times.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Whirr {
    /// The rate at which f⁻³ falls, s².
    rate: f64,
    /// Its standard error as a share of it.
    error: f64,
}

impl Whirr {
    pub(crate) fn schema() -> TableKind {
        fields(vec![
            readings(
                "time_s",
                "When the pitch was read, at least twice.",
                Bounds::closed(-1e4, 1e4),
            ),
            readings(
                "frequency_hz",
                "How often the contact goes round, per second: the pitch.",
                Bounds::above_zero(1e5),
            ),
            error(
                "frequency_error",
                "Standard error of a frequency, as a share of it.",
                0.3,
                0.03,
            ),
        ])
    }

    pub(crate) fn read(values: &Values) -> Result<Self, ReadError> {
        let times = values.numbers("time_s")?;
        let frequencies = values.numbers("frequency_hz")?;
        if times.len() != frequencies.len() {
            let message = format!(
                "{} times, but {} frequencies",
                times.len(),
                frequencies.len()
            );
            return Err(ReadError::new(message).at("frequency_hz"));
        }
        if times.len() < 2 {
            let message = "the pitch is needed at two times at least";
            return Err(ReadError::new(message).at("time_s"));
        }
        let readings: Vec<_> = times
            .iter()
            .copied()
            .zip(frequencies.iter().copied())
            .collect();
        let fitted = line(&readings, values.number("frequency_error")?);
        let Some((rate, error)) = fitted else {
            let message =
                "the pitch of a whirring coin rises with time, and these frequencies do not";
            return Err(ReadError::new(message).at("frequency_hz"));
        };
        Ok(Self { rate, error })
    }
}

/// Rounds of weighing the readings by the line through them.
const ROUNDS: usize = 20;

/// The rate at which f⁻³ falls, and its standard error as a share of it, by weighted least squares: an error
/// of f by the share s is one of f⁻³ by the share 3 s. Residuals that scatter more than that widen the error.
fn line(readings: &[(f64, f64)], share: f64) -> Option<(f64, f64)> {
    let cubes: Vec<_> = readings
        .iter()
        .map(|(time, f)| (*time, 1.0 / (f * f * f)))
        .collect();
    let mut fitted: Vec<f64> = cubes.iter().map(|(_, y)| *y).collect();
    let mut found = None;
    for _ in 0..ROUNDS {
        // a line may reach 0 at a reading, but no reading is exact
        let weights: Vec<f64> = cubes
            .iter()
            .zip(&fitted)
            .map(|((_, y), fitted)| {
                let error = 3.0 * share * fitted.max(0.2 * y);
                1.0 / (error * error)
            })
            .collect();
        let total: f64 = weights.iter().sum();
        let mean = |of: &dyn Fn(&(f64, f64)) -> f64| {
            let sum: f64 = cubes.iter().zip(&weights).map(|(c, w)| w * of(c)).sum();
            sum / total
        };
        let (t, y) = (mean(&|c| c.0), mean(&|c| c.1));
        let spread = mean(&|c| (c.0 - t) * (c.0 - t));
        if spread <= 0.0 {
            return None;
        }
        let slope = mean(&|c| (c.0 - t) * (c.1 - y)) / spread;
        let misfit: f64 = cubes
            .iter()
            .zip(&weights)
            .map(|(c, w)| w * (c.1 - y - slope * (c.0 - t)) * (c.1 - y - slope * (c.0 - t)))
            .sum();
        let degrees = (readings.len() - 2).max(1) as f64;
        let inflation = (misfit / degrees).max(1.0);
        let error = (inflation / (total * spread)).sqrt();
        found = Some((-slope, error));
        fitted = cubes.iter().map(|c| y + slope * (c.0 - t)).collect();
    }
    let (rate, error) = found?;
    (rate > 0.0).then_some((rate, error / rate))
}

/// f⁻³ falls by this times ρ_c in a second: (2π)³ k_t/(g R²).
pub(crate) fn rate_per_length(scene: &Scene) -> f64 {
    let radius = scene.coin.radius_m();
    TAU * TAU * TAU * scene.coin.transverse_gyration_m2() / (scene.gravity_m_s2() * radius * radius)
}

impl Reduce for Whirr {
    const KIND: Kind = Kind::Whirr;

    fn reduce(&self, scene: &Scene) -> Vec<Reduced> {
        vec![Reduced {
            law: Law::Times(Parameter::RollingFriction, rate_per_length(scene)),
            value: self.rate,
            absolute: 0.0,
            relative: self.error,
        }]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rate_of_an_exact_whirr_is_found() {
        let (rate, end) = (2e-6, 4.0);
        let pitch = |t: f64| libm::pow(rate * (end - t), -1.0 / 3.0);
        let readings = [0.0, 1.0, 2.0, 3.0, 3.7].map(|t| (t, pitch(t)));
        let (found, error) = line(&readings, 0.03).unwrap();
        assert!((found / rate - 1.0).abs() < 1e-9, "{found}");
        assert!(error > 0.02 && error < 0.1, "{error}");
        assert!(line(&[(0.0, 50.0), (1.0, 40.0)], 0.03).is_none());
        assert!(line(&[(1.0, 40.0), (1.0, 50.0)], 0.03).is_none());
    }
}

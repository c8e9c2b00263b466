//! How the pitch of a whirring coin (Euler's disk) rises: nearly, f⁻³ falls linearly with time.

use super::readings::{error, readings};
use super::{Kind, Law, Reduce, Reduced};
use crate::Parameter;
use coinmc_core::Scene;
use coinmc_core::schema::{Bounds, ReadError, TableKind, Values, fields};
use std::f64::consts::TAU;

/// Frequencies at times.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Whirr {
    /// Times, s, and frequencies, 1/s.
    readings: Vec<(f64, f64)>,
    /// Standard error of a frequency as a share of it.
    share: f64,
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
        let share = values.number("frequency_error")?;
        let thin = |(time, f): &(f64, f64)| (*time, 1.0 / (f * f * f));
        if line(&readings.iter().map(thin).collect::<Vec<_>>(), share).is_none() {
            let message =
                "the pitch of a whirring coin rises with time, and these frequencies do not";
            return Err(ReadError::new(message).at("frequency_hz"));
        }
        Ok(Self { readings, share })
    }
}

/// Rounds of weighing the readings by the line through them.
const ROUNDS: usize = 20;

/// The rate at which y, about in proportion to f⁻³, falls with time, and its standard error as a share of it, by
/// weighted least squares: an error of f by the share s is one of f⁻³ by the share 3 s. Residuals that scatter
/// more than that widen the error.
fn line(cubes: &[(f64, f64)], share: f64) -> Option<(f64, f64)> {
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
        let degrees = cubes.len().saturating_sub(2).max(1) as f64;
        let inflation = (misfit / degrees).max(1.0);
        let error = (inflation / (total * spread)).sqrt();
        found = Some((-slope, error));
        fitted = cubes.iter().map(|c| y + slope * (c.0 - t)).collect();
    }
    let (rate, error) = found?;
    (rate > 0.0).then_some((rate, error / rate))
}

/// f⁻³ of a thin coin falls by this times ρ_c in a second: (2π)³ k_t/(g R²).
pub(crate) fn rate_per_length(scene: &Scene) -> f64 {
    let radius = scene.coin.radius_m();
    TAU * TAU * TAU * scene.coin.transverse_gyration_m2() / (scene.gravity_m_s2() * radius * radius)
}

/// ρ_c times the time that is left to a coin which whirrs at a frequency, m s: f⁻³ over
/// [`rate_per_length`], but with the coin's thickness and its lean. `None` for a pitch too low for whirring.
///
/// Derived in docs/methods/calibrate.md. Lengths are in R, times in sqrt(R/g).
fn length_times_time_left(scene: &Scene, frequency_hz: f64) -> Option<f64> {
    let radius = scene.coin.radius_m();
    let time = (radius / scene.gravity_m_s2()).sqrt();
    let h = 0.5 * scene.coin.height_m() / radius;
    let kt = scene.coin.transverse_gyration_m2() / (radius * radius);
    let squared = |sin: f64| {
        let cos = (1.0 - sin * sin).sqrt();
        (cos - h * sin) / (sin * (kt * cos + h * (sin + h * cos)))
    };
    let round = TAU * frequency_hz * time;
    if squared(MOST_SINE) > round * round {
        return None;
    }
    // the rate falls as the coin leans more
    let (mut low, mut high) = (0.0, MOST_SINE);
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if squared(middle) > round * round {
            low = middle;
        } else {
            high = middle;
        }
    }
    let energy = |sin: f64| {
        let cos = (1.0 - sin * sin).sqrt();
        sin + h * cos + 0.5 * (kt + h * h) * squared(sin) * sin * sin
    };
    // dE/(Ω cos θ), in steps in which 1/Ω, in proportion to sqrt(sin θ), changes evenly
    let at = |step: u32| {
        let share = f64::from(step) / f64::from(STEPS);
        high * share * share
    };
    let slices = (0..STEPS).map(|step| {
        let (from, to) = (at(step).max(f64::MIN_POSITIVE), at(step + 1));
        let middle = 0.5 * (from + to);
        let speed = squared(middle).sqrt() * (1.0 - middle * middle).sqrt();
        let start = if step == 0 { h } else { energy(from) };
        (energy(to) - start) / speed
    });
    Some(slices.sum::<f64>() * radius * time)
}

/// A pitch rises well if the error of its rate is no more than this share of it.
const WELL: f64 = 0.15;

/// Sine of the greatest lean for which the law is meant.
const MOST_SINE: f64 = 0.8;
/// Halvings of its range, and slices of the integral.
const BISECTIONS: u32 = 60;
const STEPS: u32 = 200;

/// ρ_c, m, of a coin that whirrs in a scene, from times, s, and frequencies, 1/s, whose standard error is this
/// share of them; and its standard error as a share of it. `None` where the pitch does not rise, or is too low
/// for whirring.
///
/// # Example
/// ```
/// use coinmc_calibrate::rolling_friction_of_whirr;
/// use coinmc_core::{Coin, Scene, Surface};
/// let coin = Coin::cylinder(0.16, 0.0116)?;
/// let scene = Scene::new(coin, Surface::new(0.5, 0.3)?, 9.81)?;
/// let readings = [(0.0, 21.0), (1.0, 24.0), (2.0, 30.0), (3.0, 47.0)];
/// let (length_m, share) = rolling_friction_of_whirr(&scene, &readings, 0.03).unwrap();
/// assert!(length_m > 4e-6 && length_m < 8e-6 && share < 0.1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn rolling_friction_of_whirr(
    scene: &Scene,
    readings: &[(f64, f64)],
    share: f64,
) -> Option<(f64, f64)> {
    let left = |(time, f): &(f64, f64)| Some((*time, length_times_time_left(scene, *f)?));
    let lengths: Option<Vec<_>> = readings.iter().map(left).collect();
    line(&lengths?, share)
}

impl Reduce for Whirr {
    const KIND: Kind = Kind::Whirr;

    fn reduce(&self, scene: &Scene) -> Vec<Reduced> {
        let fitted = rolling_friction_of_whirr(scene, &self.readings, self.share);
        let Some((value, share)) = fitted else {
            return vec![];
        };
        // another rate would have been measured as well, but a pitch that hardly rises tells that the rate is small,
        // not nothing: the error of the line is that of its pitches
        let rises = share <= WELL;
        vec![Reduced {
            law: Law::Times(Parameter::RollingFriction, 1.0),
            value,
            absolute: if rises { 0.0 } else { share * value },
            relative: if rises { share } else { 0.0 },
        }]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_core::{Coin, Surface};

    #[test]
    fn the_rate_of_an_exact_whirr_is_found() {
        let (rate, end) = (2e-6, 4.0);
        let readings = [0.0, 1.0, 2.0, 3.0, 3.7].map(|t| (t, rate * (end - t)));
        let (found, error) = line(&readings, 0.03).unwrap();
        assert!((found / rate - 1.0).abs() < 1e-9, "{found}");
        assert!(error > 0.02 && error < 0.1, "{error}");
        assert!(line(&[(0.0, 50.0), (1.0, 60.0)], 0.03).is_none());
        assert!(line(&[(1.0, 60.0), (1.0, 50.0)], 0.03).is_none());
    }

    /// A pitch that hardly rises tells that rolling friction is small: usual ones of 4e-5 m are 50 errors away.
    #[test]
    fn a_pitch_that_hardly_rises_tells_of_little_friction() {
        let coin = Coin::cylinder(1.2, 0.012).unwrap();
        let scene = Scene::new(coin, Surface::new(0.5, 0.3).unwrap(), 9.81).unwrap();
        let whirr = Whirr {
            readings: vec![(0.0, 20.0), (1.0, 20.5)],
            share: 0.03,
        };
        let [told] = whirr.reduce(&scene)[..] else {
            panic!("one number");
        };
        assert!(told.value > 0.0 && told.relative == 0.0, "{told:?}");
        assert!(4e-5 - told.value > 50.0 * told.absolute, "{told:?}");
    }

    #[test]
    fn a_thin_coin_that_is_almost_flat_has_the_simple_law() {
        let of = |ratio: f64| {
            let coin = Coin::cylinder(ratio, 0.0116).unwrap();
            Scene::new(coin, Surface::new(0.5, 0.3).unwrap(), 9.81).unwrap()
        };
        let ratio = |scene: &Scene, f: f64| {
            length_times_time_left(scene, f).unwrap() * f * f * f * rate_per_length(scene)
        };
        let thin = of(1e-4);
        assert!(
            (ratio(&thin, 200.0) - 1.0).abs() < 1e-3,
            "{}",
            ratio(&thin, 200.0)
        );
        // thickness makes the same pitch belong to a smaller lean
        assert!(ratio(&of(0.16), 20.0) < 0.9);
        assert!(length_times_time_left(&thin, 5.0).is_none());
    }
}

//! How much work a calibration may take.

use crate::CalibrationError;

/// How much work a calibration may take.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Settings {
    /// Surfaces at which coins are tossed, drawn from a distribution somewhat wider than the prior.
    pub points: u64,
    /// Tosses at each.
    pub tosses: u64,
    /// Whether all surfaces share their launches. Probabilities of a few tosses that are shared by all are
    /// off by the same amount everywhere, so by default none are.
    pub paired: bool,
    /// Draws of the posterior.
    pub draws: u64,
    /// Tosses of the prediction; a quarter as many show the numerical error.
    pub predicted: u64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            points: 1024,
            tosses: 256,
            paired: false,
            draws: 4000,
            predicted: 32_768,
        }
    }
}

/// A number of the work that is out of range.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("`{name}`: {what} must be from {least} to {most}, not {given}")]
pub struct OutOfRange {
    /// The name of the setting.
    pub name: &'static str,
    /// What it counts.
    pub what: &'static str,
    /// The least.
    pub least: u64,
    /// The most.
    pub most: u64,
    /// That asked for.
    pub given: u64,
}

impl Settings {
    /// All numbers that are out of range, at once.
    pub(crate) fn check(&self) -> Result<(), CalibrationError> {
        let number = |name, what, given, least, most| OutOfRange {
            name,
            what,
            least,
            most,
            given,
        };
        let numbers = [
            number(
                "points",
                "the surfaces of the design",
                self.points,
                32,
                1 << 16,
            ),
            number(
                "tosses",
                "the tosses at each surface",
                self.tosses,
                2,
                1 << 20,
            ),
            number(
                "draws",
                "the draws of the posterior",
                self.draws,
                100,
                1_000_000,
            ),
            number(
                "predicted",
                "the tosses of the prediction",
                self.predicted,
                1024,
                1 << 32,
            ),
        ];
        let found = numbers.into_iter();
        let found: Vec<_> = found
            .filter(|number| !(number.least..=number.most).contains(&number.given))
            .collect();
        if found.is_empty() {
            Ok(())
        } else {
            Err(CalibrationError::OutOfRange(found))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_numbers_out_of_range_are_told_at_once() {
        assert!(Settings::default().check().is_ok());
        let settings = Settings {
            points: 31,
            draws: 1_000_001,
            ..Settings::default()
        };
        let error = settings.check().expect_err("two numbers out of range");
        assert_eq!(
            error.to_string(),
            "`points`: the surfaces of the design must be from 32 to 65536, not 31\n\
             `draws`: the draws of the posterior must be from 100 to 1000000, not 1000001"
        );
    }
}

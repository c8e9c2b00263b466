//! How much work a calibration may take.

use crate::CalibrationError;

/// How much work a calibration may take.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Settings {
    /// Surfaces at which coins are tossed, drawn from the prior.
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

impl Settings {
    pub(crate) fn check(&self) -> Result<(), CalibrationError> {
        let within = |what, given, least, most| {
            if (least..=most).contains(&given) {
                Ok(())
            } else {
                Err(CalibrationError::OutOfRange {
                    what,
                    least,
                    most,
                    given,
                })
            }
        };
        within("the surfaces of the design", self.points, 32, 1 << 16)?;
        within("the tosses at each surface", self.tosses, 2, 1 << 20)?;
        within("the draws of the posterior", self.draws, 100, 1_000_000)?;
        within(
            "the tosses of the prediction",
            self.predicted,
            1024,
            1 << 32,
        )
    }
}

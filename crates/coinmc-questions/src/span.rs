//! From where to where a number may be.

use crate::QuestionError;
use libm::{exp, log};

/// From where to where a number may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Span {
    pub(crate) from: f64,
    pub(crate) to: f64,
}

impl Span {
    /// Whether its parts are even in the logarithm: where to > 10 · from > 0.
    pub(crate) fn is_logarithmic(self) -> bool {
        self.from > 0.0 && self.to > 10.0 * self.from
    }

    /// The value at this share of the way, 0 to 1.
    pub(crate) fn at(self, share: f64) -> f64 {
        if self.is_logarithmic() {
            exp(log(self.from) + share * (log(self.to) - log(self.from)))
        } else {
            self.from + share * (self.to - self.from)
        }
    }

    /// That it leads from a finite number to a larger one.
    pub(crate) fn check(self) -> Result<(), QuestionError> {
        let Self { from, to } = self;
        if from.is_finite() && to.is_finite() && from < to {
            Ok(())
        } else {
            Err(QuestionError::Range { from, to })
        }
    }
}

/// To 12 digits, so that 0.1 does not become 0.10000000000000002.
pub(crate) fn rounded(value: f64) -> f64 {
    format!("{value:.11e}").parse().unwrap_or(value)
}

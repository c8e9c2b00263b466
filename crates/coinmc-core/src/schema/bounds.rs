//! Bounds of numbers, stated once for configs and engines.

use std::fmt;
use thiserror::Error;

/// A number outside its range.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("{name} must be {bounds}, not {found}")]
pub struct OutOfRange {
    /// Name of the number.
    pub name: &'static str,
    /// The allowed range.
    pub bounds: Bounds,
    /// The value found.
    pub found: f64,
}

/// Whole numbers from `low` to `high`, both allowed.
#[derive(Debug, Clone, Copy)]
pub struct Whole {
    /// The smallest.
    pub low: u64,
    /// The largest.
    pub high: u64,
}

impl Whole {
    /// Counts of at least 1.
    pub const COUNT: Self = Self {
        low: 1,
        high: u32::MAX as u64,
    };

    /// Checks a number; `name` is its name in the message.
    ///
    /// # Errors
    /// [`OutOfRange`] if it is out of range.
    pub fn check(self, name: &'static str, found: impl Into<u64>) -> Result<(), OutOfRange> {
        let Self { low, high } = self;
        Bounds::closed(low as f64, high as f64).check(name, found.into() as f64)
    }
}

/// Numbers from `low` to `high`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// Whether `low` and `high` themselves are excluded.
    pub open: (bool, bool),
}

impl Bounds {
    /// Both ends are allowed.
    pub const fn closed(low: f64, high: f64) -> Self {
        Self {
            low,
            high,
            open: (false, false),
        }
    }

    /// Both ends are excluded.
    pub const fn open(low: f64, high: f64) -> Self {
        Self {
            low,
            high,
            open: (true, true),
        }
    }

    /// Positive numbers up to and including `high`.
    pub const fn above_zero(high: f64) -> Self {
        Self {
            low: 0.0,
            high,
            open: (true, false),
        }
    }

    /// Whether a number is within the bounds.
    pub fn contains(&self, x: f64) -> bool {
        (x > self.low || (x == self.low && !self.open.0))
            && (x < self.high || (x == self.high && !self.open.1))
    }

    /// Checks a number; `name` is its name in the message.
    ///
    /// # Errors
    /// [`OutOfRange`] if it is out of range.
    pub fn check(self, name: &'static str, found: f64) -> Result<(), OutOfRange> {
        if self.contains(found) {
            return Ok(());
        }
        let bounds = self;
        Err(OutOfRange {
            name,
            bounds,
            found,
        })
    }
}

impl fmt::Display for Bounds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (low, high) = (short(self.low), short(self.high));
        match self.open {
            (false, false) => write!(f, "from {low} to {high}"),
            (false, true) => write!(f, "at least {low} and below {high}"),
            (true, false) => write!(f, "above {low} and at most {high}"),
            (true, true) => write!(f, "above {low} and below {high}"),
        }
    }
}

/// A limit as a person writes it: `0.5`, `1e-12`.
fn short(x: f64) -> String {
    if x == 0.0 || (1e-3..1e5).contains(&x.abs()) {
        format!("{x}")
    } else {
        format!("{x:e}")
    }
}

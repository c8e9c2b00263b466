//! Limits of numbers. Each is stated once: what a config shows is what an engine enforces.

use std::fmt;
use thiserror::Error;

/// A number outside its range.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("{name} must be {bounds}, not {found}")]
pub struct OutOfRange {
    /// What the number is called.
    pub name: &'static str,
    /// Where it must lie.
    pub bounds: Bounds,
    /// What was given.
    pub found: f64,
}

/// Whole numbers from `low` to `high`, both allowed.
#[derive(Debug, Clone, Copy)]
pub struct Whole {
    /// The least.
    pub low: u64,
    /// The greatest.
    pub high: u64,
}

impl Whole {
    /// Counts, of which there is at least one.
    pub const COUNT: Self = Self {
        low: 1,
        high: u32::MAX as u64,
    };

    /// Whether a number of this name is one of them.
    ///
    /// # Errors
    /// [`OutOfRange`] if not.
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
    /// Whether `low` and `high` themselves are out.
    pub open: (bool, bool),
}

impl Bounds {
    /// The ends are in.
    pub const fn closed(low: f64, high: f64) -> Self {
        Self {
            low,
            high,
            open: (false, false),
        }
    }

    /// The ends are out.
    pub const fn open(low: f64, high: f64) -> Self {
        Self {
            low,
            high,
            open: (true, true),
        }
    }

    /// Positive numbers up to `high`, which is in.
    pub const fn above_zero(high: f64) -> Self {
        Self {
            low: 0.0,
            high,
            open: (true, false),
        }
    }

    /// Whether a number is one of them.
    pub fn contains(&self, x: f64) -> bool {
        (x > self.low || (x == self.low && !self.open.0))
            && (x < self.high || (x == self.high && !self.open.1))
    }

    /// Whether a number of this name is one of them.
    ///
    /// # Errors
    /// [`OutOfRange`] if not.
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

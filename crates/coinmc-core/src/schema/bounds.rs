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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_end_is_in_or_out_as_the_bounds_say() {
        let half_open = Bounds {
            open: (false, true),
            ..Bounds::closed(1.0, 2.0)
        };
        for (bounds, low, high) in [
            (Bounds::closed(1.0, 2.0), true, true),
            (Bounds::open(1.0, 2.0), false, false),
            (half_open, true, false),
        ] {
            assert_eq!((bounds.contains(1.0), bounds.contains(2.0)), (low, high));
            assert_eq!(bounds.check("x", 1.0).is_ok(), low);
            assert!(bounds.check("x", 1.5).is_ok());
            for bad in [0.999, 2.001, f64::NAN, f64::INFINITY] {
                assert!(bounds.check("x", bad).is_err(), "{bad}");
            }
        }
    }

    #[test]
    fn whole_numbers_from_the_smallest_to_the_largest() {
        let whole = Whole { low: 2, high: 4 };
        for (number, ok) in [(1_u32, false), (2, true), (4, true), (5, false)] {
            assert_eq!(whole.check("n", number).is_ok(), ok, "{number}");
        }
        let error = whole.check("n", 7_u32).unwrap_err().to_string();
        assert_eq!(error, "n must be from 2 to 4, not 7");
    }

    /// Messages give limits as people write them: powers of ten only for very small and large ones.
    #[test]
    fn limits_are_written_as_people_do() {
        for (low, high, text) in [
            (0.0, 1e-12, "from 0 to 1e-12"),
            (-0.5, 99_999.0, "from -0.5 to 99999"),
            (0.001, 1e5, "from 0.001 to 1e5"),
            (0.000_9, 2.5e6, "from 9e-4 to 2.5e6"),
        ] {
            assert_eq!(Bounds::closed(low, high).to_string(), text);
        }
        assert_eq!(Bounds::open(0.0, 1.0).to_string(), "above 0 and below 1");
    }
}

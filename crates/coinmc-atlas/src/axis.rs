//! What the probabilities depend on, and how far the atlas knows it.

use serde::{Deserialize, Serialize};

/// A number of the scene that the atlas varies.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Axis {
    /// The name of its column in results.
    pub name: String,
    /// Its least value.
    pub from: f64,
    /// Its largest value.
    pub to: f64,
    /// Whether the points of the design lie evenly in its logarithm.
    pub log: bool,
}

impl Axis {
    /// Where a value lies between the ends, from -1 to 1.
    pub(crate) fn coordinate(&self, value: f64) -> f64 {
        let t = if self.log {
            libm::log(value / self.from) / libm::log(self.to / self.from)
        } else {
            (value - self.from) / (self.to - self.from)
        };
        2.0 * t - 1.0
    }

    /// Whether the atlas reaches that far.
    pub fn holds(&self, value: f64) -> bool {
        self.from <= value && value <= self.to
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_go_from_minus_one_to_one() {
        let axis = |log| Axis {
            name: "friction".to_owned(),
            from: 0.1,
            to: 10.0,
            log,
        };
        for log in [false, true] {
            assert_eq!(axis(log).coordinate(0.1), -1.0);
            assert!((axis(log).coordinate(10.0) - 1.0).abs() < 1e-15);
        }
        assert!(axis(true).coordinate(1.0).abs() < 1e-15);
        assert!(axis(true).holds(10.0) && !axis(true).holds(10.1));
    }
}

//! The result of an integration.

use crate::method::Method;

/// The probability of a face with its interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Share {
    /// The probability.
    pub p: f64,
    /// Lower end of the interval.
    pub lo: f64,
    /// Upper end.
    pub hi: f64,
}

impl Share {
    /// A probability that is exact to rounding.
    pub(crate) fn exact(p: f64) -> Self {
        Self { p, lo: p, hi: p }
    }

    /// The larger distance from the probability to an end of the interval.
    pub fn half_width(&self) -> f64 {
        (self.hi - self.p).max(self.p - self.lo)
    }
}

/// The probabilities of an adhesive scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Integral {
    /// How they were found.
    pub method: Method,
    /// Heads, tails, side.
    pub faces: [Share; 3],
    /// Evaluations of the integrand: 0 for a rule, 1 if nothing is left to integrate over.
    pub evaluations: u64,
    /// The probabilities are exact to rounding; otherwise their intervals are Student's.
    pub exact: bool,
}

impl Integral {
    /// P(side).
    pub fn side(&self) -> &Share {
        &self.faces[2]
    }

    /// The largest half width of the three intervals.
    pub fn half_width(&self) -> f64 {
        self.faces.iter().map(Share::half_width).fold(0.0, f64::max)
    }
}

//! A number and its interval.

use coinmc_core::inverse_normal_cdf;

/// A number and its interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// The number.
    pub value: f64,
    /// Lower end of its interval.
    pub lo: f64,
    /// Upper end.
    pub hi: f64,
}

impl Interval {
    /// The interval of a number with this standard error, by the normal distribution.
    pub(crate) fn normal(value: f64, error: f64, confidence: f64) -> Self {
        let arm = normal_quantile(confidence) * error;
        Self {
            value,
            lo: value - arm,
            hi: value + arm,
        }
    }

    /// Half its width.
    pub fn half_width(&self) -> f64 {
        0.5 * (self.hi - self.lo)
    }

    /// Times a positive factor.
    pub(crate) fn scaled(self, factor: f64) -> Self {
        Self {
            value: factor * self.value,
            lo: factor * self.lo,
            hi: factor * self.hi,
        }
    }
}

/// How many standard errors an interval of this confidence reaches to either side.
pub(crate) fn normal_quantile(confidence: f64) -> f64 {
    -inverse_normal_cdf((1.0 - confidence) / 2.0)
}

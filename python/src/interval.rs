//! Intervals of proportions, as in results.

use crate::errors;
use coinmc_core::{Estimate, IntervalMethod};
use pyo3::prelude::*;

/// The fraction of `successes` in `n` tosses, `undecided` of them without a face, and both ends of
/// Wilson's interval.
#[pyfunction]
pub(crate) fn wilson(
    successes: u64,
    undecided: u64,
    n: u64,
    confidence: f64,
) -> PyResult<(f64, f64, f64)> {
    if successes.checked_add(undecided).is_none_or(|some| some > n) {
        let counts = format!("{successes} and {undecided} of {n} tosses are more than all");
        return Err(errors::value(counts));
    }
    let found = Estimate::new(successes, undecided, n, confidence, IntervalMethod::Wilson);
    Ok((found.p, found.lo, found.hi))
}

/// Inverse of the standard normal CDF, for p in (0, 1).
#[pyfunction]
pub(crate) fn inverse_normal_cdf(p: f64) -> f64 {
    coinmc_core::inverse_normal_cdf(p)
}

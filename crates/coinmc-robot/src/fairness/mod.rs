//! Is the robot fair? Exact tests, each with the smallest bias that it could have detected.
//!
//! The checks that Gaek & Sukhov (arXiv 2401.03557) made of their robot: a coin shows heads half of
//! the time, a die shows every face a sixth of the time, and measured spins and angles are uniform.
//! A test that finds nothing means little without its power, so each comes with the smallest bias
//! that the same number of throws detects with a probability of 80 % and of 95 %.

mod binomial;
mod kolmogorov;
mod report;

pub use binomial::{Binomial, Power};
pub use kolmogorov::{distance, kolmogorov_p_value};
pub use report::{Check, FairnessReport, Interval, die_check, fairness};

/// Significance level of the tests, for which their power is stated.
pub const SIGNIFICANCE: f64 = 0.05;

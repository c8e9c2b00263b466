//! Is the robot fair, and how sure is that: exact tests, each with the bias it could have revealed.
//!
//! The checks of Gaek & Sukhov (arXiv 2401.03557) on their robot: a coin shows heads half of the
//! time, a die every face a sixth of it, and achieved spins and angles are uniform. A test that
//! finds nothing says little without its power, so each comes with the smallest bias that as many
//! throws reveal with a probability of 80 % and of 95 %.

mod binomial;
mod kolmogorov;
mod report;

pub use binomial::{Binomial, Power};
pub use kolmogorov::{distance, kolmogorov_p_value};
pub use report::{Check, FairnessReport, Interval, die_check, fairness};

/// Below this p-value a test speaks up; what power is stated for.
pub const SIGNIFICANCE: f64 = 0.05;

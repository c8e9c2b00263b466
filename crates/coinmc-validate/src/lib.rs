#![doc = include_str!("../README.md")]
//!
//! # Contents
//! ```text
//! claims ──each tosses its scenes──▶ Finding { verdict, evidence }     ┐
//! data sets ──one prior──▶ predictive distribution ──▶ p-value         ├──▶ Validation ──document──▶ JSON
//!                                                                      ┘
//! ```
//! * [`validate()`] checks claims and predicts data sets; [`names()`] lists them.
//! * A claim is an entry of the list in `claims/mod.rs`, with a function that tosses and judges.
//! * A data set is an entry of the list in `sets/list.rs`; its numbers are in `data/`.
//! * [`document()`] is the result as JSON, [`flat_rows`] its rows without nesting, for CSV.

mod claims;
mod document;
mod error;
mod predictive;
mod prior;
mod sets;
mod size;
mod tosser;
mod trend;
mod validate;
mod verdict;

pub use claims::{Checked, Claim, Family};
pub use document::{document, flat_rows};
pub use error::ValidateError;
pub use sets::{DataSet, Kind, Line, Predicted};
pub use size::Size;
pub use validate::{Options, Validation, names, validate};
pub use verdict::{Evidence, Finding, Verdict};

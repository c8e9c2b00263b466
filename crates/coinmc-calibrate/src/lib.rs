#![doc = include_str!("../README.md")]
//!
//! # How it works
//! ```text
//! config ─▶ Observations (priors, counts, readings)
//!              │ Sobol points of the prior, tosses at each, polynomial logits
//!              ▼
//!           Model ── log_prob, simulate ──▶ any sampler
//!              │ adaptive importance sampling
//!              ▼
//!           Posterior ──▶ Prediction, FairRatio, suggestions: a Calibration
//! ```
//!
//! # Files
//! `observations` the config · `measured` each kind of measurement · `parameter`, `prior` what is unknown ·
//! `points`, `tosses` the design · `chances` the probabilities of faces as a smooth function · `model` the
//! likelihood · `importance`, `posterior` the posterior · `conflicts`, `remarks` what does not fit or stays open ·
//! `prediction`, `fair` the answers · `information` what to measure next · `simulate` synthetic measurements ·
//! `document`, `table` JSON, CSV and Parquet.

mod calibration;
mod chances;
mod conflicts;
mod document;
mod error;
mod fair;
mod importance;
mod information;
mod measured;
mod model;
mod observations;
mod parameter;
mod points;
mod posterior;
mod prediction;
mod prior;
mod remarks;
mod rolls;
mod settings;
mod simulate;
mod table;
mod tosses;

pub use calibration::{Calibration, FitOf};
pub use conflicts::Conflict;
pub use document::document;
pub use error::CalibrationError;
pub use fair::FairRatio;
pub use information::Suggestion;
pub use measured::{Kind, Law, Reading, rolling_friction_of_whirr};
pub use model::Model;
pub use observations::{Counted, Observations};
pub use parameter::Parameter;
pub use posterior::{Posterior, Summary};
pub use prediction::{Predicted, Prediction};
pub use prior::Prior;
pub use settings::{OutOfRange, Settings};
#[cfg(feature = "parquet")]
pub use table::parquet::write_parquet;
pub use table::{columns, csv};
pub use tosses::point_with;

#![doc = include_str!("../README.md")]
//!
//! # Contents
//! ```text
//! Template (a config in which numbers are replaced) + Question ──fair──▶ Fair { curves, roots }
//!                                                   + Aim      ──aim───▶ Aimed { map, best, worst, … }
//!                                                   + Rank     ──rank──▶ Ranking { numbers, … }
//!                                                   + HowRare  ─how_rare▶ Rareness { p, gain, … }
//! ```
//! * [`fair()`] finds the values of a parameter at which a face has a given probability.
//! * [`compare()`] compares counts of real tosses with the points of a run.
//! * [`converge()`] tells how far numerical settings move the probabilities.
//! * [`aim()`] finds the launches that force a face.
//! * [`design()`] makes a fair coin to print.
//! * [`scenes`] are everyday scenes, with where each of their numbers comes from.
//! * [`assumptions`] tells how far each assumption moves the answer.
//! * [`how_rare`] estimates the probability of a rare face with fewer tosses.
//! * [`rank()`] finds which unknown of a scene matters most.
//! * [`sensitivity`] tells how the probabilities move with every number of a scene.
//! * [`tosses_for_power`] says how many tosses test a coin.

mod aim;
pub mod assumptions;
mod changes;
mod compare;
mod converge;
mod design;
mod document;
mod drawing;
mod error;
mod fair;
mod interval;
pub mod number;
mod power;
mod ranking;
mod rare;
mod rows;
pub mod scenes;
mod seen;
pub mod sensitivity;
mod span;
mod template;
mod workers;

pub use aim::{
    Aim, Aimed, Clumsy, MOST_FACTORS, MOST_PLACES, MOST_TOSSES, Parameter, Place, aim,
    document_of_aim, picture,
};
pub use compare::{
    Compared, Comparison, MOST_COUNTED, MOST_MODELS, Model, compare, document_of_comparison,
};
pub use converge::{Converged, Convergence, Tightened, converge, document_of_convergence};
pub use design::{
    Design, DesignError, DesignFile, Designed, Faces, PRINTED_DIAMETER_M, PrintedCoin, TEST,
    THICKNESS_ERRORS_M, design, diameter_told, document_of_design,
};
pub use document::document;
pub use error::QuestionError;
pub use fair::{
    Curve, Fair, Finding, LEAST_TOSSES, Numerical, Question, Root, Round, Scanned, fair,
    finer_settings, natural_range,
};
pub use interval::Interval;
pub use power::{Test, tosses_for_power};
pub use ranking::{
    LEAST_SAMPLES, MOST_SAMPLES, MOST_UNKNOWNS, Rank, Ranked, Ranking, Unknown,
    document_of_ranking, picture_of_ranking, rank,
};
pub use rare::{Gain, HowRare, Rareness, Stratum, document_of_rare, gain_expected, how_rare};
pub use rows::{csv_of_rows, csv_of_value};
pub use template::{CoinNumbers, Size, Template};
pub use workers::Workers;

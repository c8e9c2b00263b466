#![doc = include_str!("../README.md")]
//!
//! # How it works
//! ```text
//! designs/*.toml ─▶ coinmc run ─▶ Design ─▶ fit: networks, each without a part of the points
//!                                             │
//!                                  networks/*.atlas, compiled into the program
//!                                             │
//! coin, surface ─▶ Place ────────────────▶ Atlas ─▶ Faces: P and its error
//! ```
//!
//! # Files
//! `launch` the launches · `axis`, `place` what the probabilities depend on · `network` one network · `ensemble`
//! several and their error · `document` an answer · `file` their bytes · `design` what was tossed · `fit`, `train` how networks are made · `sure` tosses instead.

mod axis;
mod design;
mod document;
mod ensemble;
mod error;
mod file;
mod fit;
mod launch;
mod network;
mod place;
mod sure;
mod train;

pub use axis::Axis;
pub use design::Design;
pub use document::Answer;
pub use ensemble::{Atlas, Faces, Root};
pub use error::{AtlasError, FileError, FitError};
pub use fit::fit;
pub use launch::Launch;
pub use place::Place;
pub use sure::{Counts, scene, toss};
pub use train::Training;

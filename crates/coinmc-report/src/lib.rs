#![doc = include_str!("../README.md")]
//!
//! # Contents
//! ```text
//! Run ──report──▶ ┐
//! Trace ──tosses─▶├─ JSON ──page──▶ one HTML file: style, program and data inside, no network
//! Map ────map────▶┘
//! ```
//!
//! * [`Run`] is a run to report: read from a run directory, or in memory.
//! * [`report()`] makes the page of one or several runs.
//! * [`tosses()`] makes the page of one or several tosses in three dimensions.
//! * [`plan_hashes`] says of which runs a page is.
//! * [`claims()`] makes the page of a validation, which holds no program.
//! * [`Map`] is a map of basins: the face over two quantities of the launch. [`map()`] makes its page.
//!
//! The program of the pages lies in `web/`, in JavaScript, and is checked in as built: compiling this crate
//! needs nothing but Rust.

mod claims;
mod fair;
mod history;
mod html;
mod keyframes;
mod map;
mod motion;
mod page;
mod published;
mod quantity;
mod replay;
mod rules;
mod run;
mod samples;
mod sweep;
mod table;

pub use claims::claims;
pub use html::{inner, plan_hashes};
pub use map::{MAX_PIXELS, Map, MapError};
pub use page::{MAX_TOSSES, map, report, tosses};
pub use quantity::{Quantity, UnknownQuantity};
pub use run::{MAX_POINTS, Run};
pub use samples::Samples;

#![doc = include_str!("../README.md")]
//!
//! # Contents
//! ```text
//! Plan, point, toss ──replay──▶ Trace ──write──▶ .mcap .csv .parquet .jsonl .svg
//! ```
//!
//! * [`replay()`] repeats a toss and returns its [`Trace`]; [`record()`] does the same for any launch.
//! * [`search()`] finds tosses by how they end.
//! * [`write_csv`], [`write_parquet`], [`write_jsonl`], [`write_mcap`] and [`svg`] write traces;
//!   [`FileKind`] chooses by the name of a file.
//! * [`Recorder`] is the observer that records; it works with any engine.
//!
//! States between events are computed by the engine itself (in flight in closed form, in contact by a
//! step of its own integrator), interpolated between these on rough ground alone; times of events are exact. docs/reference/traces.md
//! describes the files.

mod condition;
mod csv;
mod end;
mod error;
mod file;
mod jsonl;
mod mcap;
#[cfg(feature = "parquet")]
mod parquet;
mod record;
mod recorder;
mod replay;
mod scene;
mod search;
pub mod svg;
mod table;
mod to_json;
mod trace;
mod turning;

pub use condition::{Condition, ConditionError};
pub use csv::write_csv;
pub use end::{EndKind, outcome_name};
pub use error::TraceError;
pub use file::{FileKind, UnknownKind};
pub use jsonl::write_jsonl;
pub use mcap::{LAYOUT, write_mcap};
#[cfg(feature = "parquet")]
pub use parquet::write_parquet;
pub use record::{Mode, Record, RecordKind};
pub use recorder::{MAX_RECORDS, Recorder};
pub use replay::{MAX_RATE_HZ, default_rate_hz, launch, outcome, record, replay, replay_within};
pub use search::{Findings, Found, Length, Query, search};
pub use table::{Column, FORMAT, columns};
pub use trace::Trace;

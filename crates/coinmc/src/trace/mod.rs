//! Traces: any toss of any run, replayed and recorded.
//!
//! A toss is fixed by the plan's seed, its point and its number, so nothing needs to be stored to
//! see it again: [`replay()`] follows it once more, bit for bit, with an observer that writes down
//! every event and the coin's state at any rate between them.
//!
//! ```text
//! Plan, point, toss ──replay──▶ Trace ──write──▶ .mcap .csv .parquet .jsonl .svg
//! ```
//!
//! States between events come from the engine itself (in flight its closed form, in contact a step
//! of its own integrator), never from interpolation; times of events are exact. The files are
//! described in docs/guide/traces.md.

mod csv;
mod error;
mod jsonl;
mod mcap;
mod parquet;
mod record;
mod recorder;
mod replay;
mod scene;
mod search;
pub mod svg;
mod table;
mod tell;
mod turning;

pub use csv::write_csv;
pub use error::TraceError;
pub use jsonl::write_jsonl;
pub use mcap::write_mcap;
pub use parquet::write_parquet;
pub use record::{Mode, Record, RecordKind};
pub use recorder::{MAX_RECORDS, Recorder};
pub use replay::{MAX_RATE_HZ, default_rate_hz, launch, outcome, record, replay, replay_within};
pub use search::{Condition, ConditionError, EndKind, Findings, Found, Length, Query, search};
pub use table::{Column, FORMAT, columns};
pub use tell::outcome_name;

use coinmc_core::{Launch, Outcome, Scene};

/// A recorded toss.
#[derive(Debug, Clone, PartialEq)]
pub struct Trace {
    /// Index of the point in the plan.
    pub point: usize,
    /// Number of the toss.
    pub toss: u64,
    /// Name of the engine that followed it.
    pub engine: &'static str,
    /// What was tossed, onto what.
    pub scene: Scene,
    /// How it began.
    pub launch: Launch,
    /// Samples a second asked for, 1/s; 0 for events alone.
    pub rate_hz: f64,
    /// How it ended: the same as in the run.
    pub outcome: Outcome,
    /// What was seen, in order of time. The first is the launch, the last the end.
    pub records: Vec<Record>,
    /// Where the recorder was full: no sample is recorded after this time, s. `None`: all are there.
    pub samples_until_s: Option<f64>,
    /// The same for events; the end is recorded always.
    pub events_until_s: Option<f64>,
}

impl Trace {
    /// When the toss ended, s since launch.
    pub fn duration_s(&self) -> f64 {
        self.records.last().map_or(0.0, |last| last.state.time_s)
    }
}

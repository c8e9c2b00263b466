//! From a plan to results: chunks are executed on all cores and stored in the run directory as they
//! finish.
//!
//! ```text
//! Plan ──cut──▶ chunks ──workers──▶ tallies/*.tally ──▶ results.csv, results.parquet
//!                           ▲             │
//!                           └── a later run resumes from them
//! ```
//!
//! The counts depend on the plan alone: not on threads, parts, machine or order, nor on how often the
//! run was killed and resumed. The files are described in docs/reference/formats.md.
//!
//! # Example
//! ```no_run
//! use coinmc::run::{Options, Part, run};
//! use std::{path::Path, sync::atomic::AtomicBool};
//! # fn example(plan: &coinmc::plan::Plan) -> Result<(), coinmc::run::RunError> {
//! let cancel = AtomicBool::new(false);
//! let report = run(plan, &Options {
//!     out: Path::new("runs/first"),
//!     part: Part::WHOLE,
//!     threads: None,
//!     cancel: &cancel,
//!     sink: &(),
//! })?;
//! for row in &report.results.rows {
//!     println!("{:?}: {} in [{}, {}]", row.parameters, row.side.p, row.side.lo, row.side.hi);
//! }
//! # Ok(())
//! # }
//! ```

mod chunk;
mod count;
mod cut;
mod damage;
mod directory;
mod each;
mod engines;
mod error;
mod integral_file;
mod manifest;
mod merge;
mod part;
mod piece;
mod progress;
mod replace;
mod schedule;
mod sealed;
mod stored;
mod tallies;
mod tally_file;
mod workers;

pub use chunk::{Chunk, run_chunk};
pub use count::{Count, count};
pub use each::{Begin, Seen, for_each_end, for_each_outcome};
pub use engines::{SettingsError, name as engine_name, stream, toss};
pub(crate) use engines::{Task, law, with_engine};
pub use error::RunError;
pub use merge::merge;
pub use part::{Part, PartError};
pub use piece::integrate_point;
pub use progress::{Progress, ProgressSink};
pub use stored::{stored_plan, stored_report};

use crate::plan::{Plan, Stop};
use crate::results::{Results, Row};
use directory::RunDirectory;
use schedule::Schedule;
use std::num::NonZeroUsize;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::thread;

/// How to run a plan. None of it changes the counts.
#[derive(Clone, Copy)]
pub struct Options<'a> {
    /// The run directory: new, empty, or that of the same run.
    pub out: &'a Path,
    /// The share of the run to do.
    pub part: Part,
    /// Threads that toss; `None` for one per core.
    pub threads: Option<NonZeroUsize>,
    /// Set it (from another thread or a signal) to stop within about 0.1 s.
    pub cancel: &'a AtomicBool,
    /// Receives the progress.
    pub sink: &'a dyn ProgressSink,
}

/// The outcome of a run.
#[derive(Debug, Clone)]
pub struct Report {
    /// All points; those of an unfinished run as far as they are counted.
    pub results: Results,
    /// Whether the run is finished.
    pub status: Status,
    /// Chunks reused from an earlier run.
    pub reused_chunks: u64,
    /// All tosses counted, including those of an earlier run.
    pub tosses: u64,
}

/// Whether a run is finished.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// Every point meets the stop rule.
    Complete,
    /// It was stopped; running it again resumes.
    Interrupted,
    /// Its part is complete; the parts can be merged.
    Part,
    /// Complete, but some points reached the largest number of tosses before the half width.
    ShortOfTarget {
        /// How many.
        points: usize,
    },
}

/// Runs a plan in a run directory, or resumes the run that the directory holds.
///
/// Ends with `results.csv` and `results.parquet` in the directory if the whole run is finished,
/// and with `results.partial.csv` if it was cancelled or only a part was asked for.
///
/// # Errors
/// [`RunError`]; finished chunks are kept, and running again resumes.
pub fn run(plan: &Plan, options: &Options<'_>) -> Result<Report, RunError> {
    if options.part != Part::WHOLE && !matches!(plan.stop, Stop::Tosses(_)) {
        return Err(RunError::PartsNeedFixedTosses);
    }
    let Options {
        out,
        part,
        threads,
        cancel,
        sink,
    } = *options;
    let directory = RunDirectory::open(out, plan, part, sink)?;
    let schedule = Schedule::new(plan, part, directory.finished(plan, sink)?);
    sink.progress(&schedule.progress());
    let store = |batch: &[_]| directory.tallies().store(batch);
    let threads = one_a_core(threads);
    let schedule = workers::execute(plan, schedule, &store, threads, cancel, sink)?;
    conclude(plan, part, schedule, &directory, sink)
}

/// The threads asked for, or one per core.
fn one_a_core(threads: Option<NonZeroUsize>) -> NonZeroUsize {
    let threads = threads.or_else(|| thread::available_parallelism().ok());
    threads.unwrap_or(NonZeroUsize::MIN)
}

/// Writes the results of a schedule and reports them.
fn conclude(
    plan: &Plan,
    part: Part,
    mut schedule: Schedule<'_>,
    directory: &RunDirectory,
    sink: &dyn ProgressSink,
) -> Result<Report, RunError> {
    let mut report = report(plan, part, &schedule);
    match report.status {
        Status::Complete | Status::ShortOfTarget { .. } => {
            directory.set_aside(&schedule.take_unneeded(), sink)?;
            directory.write_results(&report.results, sink)?;
        }
        Status::Interrupted | Status::Part => directory.write_partial(&report.results)?,
    }
    let progress = schedule.progress();
    sink.progress(&progress);
    (report.reused_chunks, report.tosses) = (progress.reused_chunks, progress.tosses_done);
    Ok(report)
}

/// The report of a schedule.
fn report(plan: &Plan, part: Part, schedule: &Schedule<'_>) -> Report {
    let points = schedule.points().iter().enumerate();
    let rows = points
        .map(|(i, point)| match &point.integral {
            Some(integral) => Row::integrated(plan, i, integral, point.reached),
            None => Row::new(plan, i, point.tally, point.reached),
        })
        .collect();
    let progress = schedule.progress();
    Report {
        results: Results::new(plan, rows),
        status: status(part, schedule),
        reused_chunks: progress.reused_chunks,
        tosses: progress.tosses_done,
    }
}

fn status(part: Part, schedule: &Schedule<'_>) -> Status {
    if !schedule.is_done() {
        return Status::Interrupted;
    }
    if part != Part::WHOLE {
        return Status::Part;
    }
    match schedule
        .points()
        .iter()
        .filter(|point| !point.reached)
        .count()
    {
        0 => Status::Complete,
        points => Status::ShortOfTarget { points },
    }
}

//! Runs a plan in a run directory.

use super::directory::RunDirectory;
use super::options::{Options, one_per_core};
use super::provenance::Maker;
use super::report::{Report, Status, report, status};
use super::schedule::{Next, Schedule};
use super::{Part, ProgressSink, RunError, workers};
use crate::plan::{Plan, Stop};
use std::sync::Arc;

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
        build,
        part,
        threads,
        cancel,
        sink,
    } = *options;
    let directory = RunDirectory::open(out, plan, part, build, sink)?;
    let plan = Arc::new(plan.clone());
    let finished = directory.finished(&plan, sink)?;
    let finished = finished.with_beginnings(directory.begun());
    let schedule = Schedule::new(&plan, part, finished);
    sink.progress(&schedule.progress());
    let maker = Maker::this(&plan, build);
    let store = |batch: &[_]| directory.store(&maker, batch);
    let threads = one_per_core(threads);
    let schedule = workers::execute(&plan, schedule, &store, threads, cancel, sink)?;
    conclude(&plan, part, schedule, &directory, sink)
}

/// Writes the results of a schedule and reports them.
pub(super) fn conclude(
    plan: &Arc<Plan>,
    part: Part,
    mut schedule: Schedule,
    directory: &RunDirectory,
    sink: &dyn ProgressSink,
) -> Result<Report, RunError> {
    let status = status(part, &schedule);
    match status {
        Status::Complete | Status::ShortOfTarget { .. } => {
            directory.take_over(&schedule.take_taken_over())?;
            directory.put_in_order(&schedule.take_unneeded(), sink)?;
        }
        Status::Part => directory.put_in_order(&[], sink)?,
        // what is stored of later points, too
        Status::Interrupted => while let Next::Chunk(_) = schedule.next() {},
    }
    sink.progress(&schedule.progress());
    let report = report(plan, status, schedule);
    match status {
        Status::Complete | Status::ShortOfTarget { .. } => {
            directory.write_results(&report.results, sink)?;
        }
        Status::Interrupted | Status::Part => directory.write_partial(&report.results)?,
    }
    Ok(report)
}

//! Runs a plan in a run directory.

use super::directory::RunDirectory;
use super::options::{Options, one_per_core};
use super::report::{Report, Status, report};
use super::schedule::Schedule;
use super::{Part, ProgressSink, RunError, workers};
use crate::plan::{Plan, Stop};

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
    let schedule = Schedule::new(plan, part, directory.finished(plan, sink)?);
    sink.progress(&schedule.progress());
    let store = |batch: &[_]| directory.tallies().store(batch);
    let threads = one_per_core(threads);
    let schedule = workers::execute(plan, schedule, &store, threads, cancel, sink)?;
    conclude(plan, part, schedule, &directory, sink)
}

/// Writes the results of a schedule and reports them.
pub(super) fn conclude(
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

//! Counts a plan in memory, without files.

use super::finished::Finished;
use super::options::one_per_core;
use super::report::{Report, report, status};
use super::schedule::Schedule;
use super::{Part, ProgressSink, RunError, workers};
use crate::plan::Plan;
use std::num::NonZeroUsize;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// How to count a plan. None of it changes what is counted.
#[derive(Clone, Copy)]
pub struct Count<'a> {
    /// Threads that toss; `None` for one a core.
    pub threads: Option<NonZeroUsize>,
    /// Set it (from another thread or a signal) to stop within about 0.1 s.
    pub cancel: &'a AtomicBool,
    /// Receives the progress.
    pub sink: &'a dyn ProgressSink,
}

/// Counts a plan: the same counts as a [`run`](super::run()), but nothing is written. If it is stopped
/// early, the report holds the counts so far and says so.
///
/// # Errors
/// [`RunError::Settings`] if an engine rejects its settings, [`RunError::Thread`].
///
/// # Example
/// ```
/// use coinmc::run::{Count, count};
/// use std::sync::atomic::AtomicBool;
/// let plan = coinmc::config::parse(
///     "inline",
///     "coin.ratio = [1.0, 2.0]\nsurface = { restitution = 0.5, friction = 0.3 }\n\
///      launch.preset = 'robot'\nengine.flat = {}\nstop.tosses = 1000",
///     &[],
/// ).unwrap();
/// let cancel = AtomicBool::new(false);
/// let report = count(&plan, &Count { threads: None, cancel: &cancel, sink: &() })?;
/// assert_eq!(report.tosses, 2000);
/// assert!(report.results.rows[1].side.p > report.results.rows[0].side.p);
/// # Ok::<(), coinmc::run::RunError>(())
/// ```
pub fn count(plan: &Plan, options: &Count<'_>) -> Result<Report, RunError> {
    let Count {
        threads,
        cancel,
        sink,
    } = *options;
    let plan = Arc::new(plan.clone());
    let schedule = Schedule::new(&plan, Part::WHOLE, Finished::default());
    sink.progress(&schedule.progress());
    // the schedule itself holds the counts
    let store = |_: &[_]| Ok(());
    let threads = one_per_core(threads);
    let schedule = workers::execute(&plan, schedule, &store, threads, cancel, sink)?;
    sink.progress(&schedule.progress());
    let status = status(Part::WHOLE, &schedule);
    Ok(report(&plan, status, schedule))
}

//! Threads that execute chunks, and the one that stores their results.

use super::chunk::compute_chunk;
use super::chunk_result::{ChunkResult, Tossed};
use super::made::{Made, Work};
use super::pace::Pace;
use super::provenance::Effort;
use super::schedule::{Job, Next, Schedule};
use super::{Chunk, ProgressSink, RunError};
use crate::plan::Plan;
use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// How many finished chunks may wait for the disk, and how many at most are stored at once.
const BATCH: usize = 4096;
/// How long an idle worker waits before it checks whether it should stop.
const IDLE_WAIT: Duration = Duration::from_millis(50);

type Done = Result<Work, RunError>;

/// Stores what workers have done, a few results at a time.
pub(super) type Store<'a> = &'a dyn Fn(&[Work]) -> Result<(), RunError>;

/// State that the threads share.
struct Shared<'a> {
    plan: &'a Plan,
    schedule: Mutex<Schedule>,
    /// Signalled when a chunk is complete: there may be new work.
    changed: Condvar,
    /// Set when the user wants to stop.
    cancel: &'a AtomicBool,
    /// Set when a thread failed: the others stop.
    broken: AtomicBool,
}

impl Shared<'_> {
    fn should_continue(&self) -> bool {
        !self.cancel.load(Relaxed) && !self.broken.load(Relaxed)
    }

    /// A poisoned lock is ignored: a panic under the lock ends the whole run anyway.
    fn schedule(&self) -> MutexGuard<'_, Schedule> {
        self.schedule.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn next_job(&self) -> Option<Job> {
        let mut schedule = self.schedule();
        while self.should_continue() {
            match schedule.next() {
                Next::Chunk(job) => return Some(job),
                Next::Done => return None,
                Next::Wait => {
                    let woken = self.changed.wait_timeout(schedule, IDLE_WAIT);
                    schedule = woken.unwrap_or_else(PoisonError::into_inner).0;
                }
            }
        }
        None
    }
}

/// Stops all threads when its own thread panics, so that the panic is reported at once.
struct StopOnPanic<'a>(&'a AtomicBool);

impl Drop for StopOnPanic<'_> {
    fn drop(&mut self) {
        if thread::panicking() {
            self.0.store(true, Relaxed);
        }
    }
}

/// Executes all chunks of the schedule, or as many as are complete before `cancel` is set, and
/// returns the schedule. Every result that it counts has been stored.
pub(super) fn execute(
    plan: &Plan,
    schedule: Schedule,
    store: Store<'_>,
    threads: NonZeroUsize,
    cancel: &AtomicBool,
    sink: &dyn ProgressSink,
) -> Result<Schedule, RunError> {
    let shared = Shared {
        plan,
        schedule: Mutex::new(schedule),
        changed: Condvar::new(),
        cancel,
        broken: AtomicBool::new(false),
    };
    thread::scope(|scope| {
        let _stop_on_panic = StopOnPanic(&shared.broken);
        let (sender, receiver) = sync_channel(BATCH);
        let mut started = Ok(());
        for _ in 0..threads.get() {
            let (sender, shared) = (sender.clone(), &shared);
            let worker = thread::Builder::new().spawn_scoped(scope, move || work(shared, &sender));
            if let Err(error) = worker {
                shared.broken.store(true, Relaxed);
                started = Err(RunError::Thread(error));
                break;
            }
        }
        drop(sender);
        let stored = store_results(&shared, &receiver, store, sink);
        if stored.is_err() {
            shared.broken.store(true, Relaxed);
        }
        started.and(stored)
    })?;
    Ok(shared
        .schedule
        .into_inner()
        .unwrap_or_else(PoisonError::into_inner))
}

fn work(shared: &Shared<'_>, sender: &SyncSender<Done>) {
    let _stop_on_panic = StopOnPanic(&shared.broken);
    let mut pace = Pace::new(Instant::now());
    while let Some(job) = shared.next_job() {
        let report = |work| sender.send(Ok(work)).is_ok();
        let done = if shared.plan.integrates(job.chunk.point) {
            integrate(shared, job.chunk, report)
        } else {
            toss(shared, job, &mut pace, report)
        };
        let goes_on = match done {
            Ok(goes_on) => goes_on,
            Err(error) => sender.send(Err(error)).is_ok(),
        };
        if !goes_on {
            return;
        }
    }
}

/// Integrates a point; false if the worker is to stop.
fn integrate(
    shared: &Shared<'_>,
    chunk: Chunk,
    report: impl Fn(Work) -> bool,
) -> Result<bool, RunError> {
    let one = NonZeroUsize::MIN;
    let Some(made) = compute_chunk(shared.plan, chunk, one, || shared.should_continue())? else {
        return Ok(false);
    };
    Ok(finish(shared, made.result, made, report))
}

/// Tosses a chunk, or the rest of it, a stretch at a time, and reports after each; false if the worker is to
/// stop.
fn toss(
    shared: &Shared<'_>,
    Job { chunk, begun }: Job,
    pace: &mut Pace,
    report: impl Fn(Work) -> bool,
) -> Result<bool, RunError> {
    let (point, first) = (chunk.point, chunk.tosses.start);
    let mut sum = begun.map_or_else(Tossed::none, |begun| *begun);
    let mut effort = Effort::NONE;
    let mut start = first + sum.tally.tosses();
    pace.reports(Instant::now());
    let report_beginning = |sum, end| {
        let tosses = first..end;
        tosses.is_empty() || report(Work::Begun(Chunk { point, tosses }, sum))
    };
    loop {
        let end = start + pace.stretch(chunk.tosses.end - start);
        let (one, begun_at) = (NonZeroUsize::MIN, Instant::now());
        let stretch = Chunk {
            point,
            tosses: start..end,
        };
        let computed = compute_chunk(shared.plan, stretch, one, || shared.should_continue())?;
        let Some(made) = computed else {
            // what is counted is stored
            report_beginning(sum, start);
            return Ok(false);
        };
        let ChunkResult::Tossed(tossed) = made.result else {
            unreachable!("the point is tossed");
        };
        let now = Instant::now();
        pace.took(end - start, now - begun_at);
        effort = effort.and(made.effort);
        sum.tally.merge(&tossed.tally);
        sum.microseconds += tossed.microseconds;
        if end == chunk.tosses.end {
            let result = ChunkResult::Tossed(sum);
            let whole = Made {
                chunk,
                result,
                effort,
            };
            return Ok(finish(shared, made.result, whole, report));
        }
        shared.schedule().add(point, &made.result);
        start = end;
        if pace.is_due(now) {
            pace.reports(now);
            if !report_beginning(sum, end) {
                return Ok(false);
            }
        }
    }
}

/// Counts the last result of a chunk and reports the whole; false if the worker is to stop.
fn finish(
    shared: &Shared<'_>,
    last: ChunkResult,
    whole: Made,
    report: impl Fn(Work) -> bool,
) -> bool {
    shared.schedule().complete(&whole.chunk, &last);
    shared.changed.notify_all();
    report(Work::Finished(whole))
}

/// Stores results as they arrive until all workers have ended. It has its own thread, so that no
/// worker waits for the disk.
fn store_results(
    shared: &Shared<'_>,
    receiver: &Receiver<Done>,
    store: Store<'_>,
    sink: &dyn ProgressSink,
) -> Result<(), RunError> {
    while let Ok(first) = receiver.recv() {
        let batch = std::iter::once(first)
            .chain(receiver.try_iter())
            .take(BATCH);
        let (mut stored, mut failed) = (Vec::new(), None);
        for done in batch {
            match done {
                Ok(work) => stored.push(work),
                Err(error) => failed = failed.or(Some(error)),
            }
        }
        store(&stored)?;
        if let Some(error) = failed {
            return Err(error);
        }
        sink.progress(&shared.schedule().progress());
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::Part;
    use crate::run::finished::Finished;
    use crate::run::schedule::tests::plan_of_one;

    /// The time of a point is that of all stretches of all its chunks.
    #[test]
    fn computing_time_is_measured_where_it_is_limited() {
        for (limit, is_limited) in [("", false), ("max_core_seconds = 1e6", true)] {
            let plan = plan_of_one(&format!("half_width = 0.1\nmax_tosses = 1000\n{limit}"));
            let schedule = Schedule::new(&plan, Part::WHOLE, Finished::default());
            let times = Mutex::new(Vec::new());
            let store = |batch: &[Work]| {
                for work in batch {
                    if let Work::Finished(Made {
                        result: ChunkResult::Tossed(tossed),
                        ..
                    }) = work
                    {
                        times.lock().unwrap().push(tossed.microseconds);
                    }
                }
                Ok(())
            };
            let (one, cancel) = (NonZeroUsize::MIN, AtomicBool::new(false));
            execute(&plan, schedule, &store, one, &cancel, &()).unwrap();
            let times = times.into_inner().unwrap();
            // a thousand tosses take longer than a microsecond
            assert!(!times.is_empty());
            assert_eq!(times.iter().sum::<u64>() > 0, is_limited, "{times:?}");
        }
    }

    /// What is counted of a chunk is reported when the worker is to stop, and nothing if nothing is.
    #[test]
    fn a_worker_that_is_stopped_reports_what_it_has() {
        let plan = plan_of_one("tosses = 1000");
        let schedule = Schedule::new(&plan, Part::WHOLE, Finished::default());
        let shared = Shared {
            plan: &plan,
            schedule: Mutex::new(schedule),
            changed: Condvar::new(),
            cancel: &AtomicBool::new(true),
            broken: AtomicBool::new(false),
        };
        let chunk = |tosses| Chunk { point: 0, tosses };
        let mut begun = Tossed::none();
        begun.tally.heads = 40;
        for (begun, expected) in [(None, None), (Some(begun), Some((chunk(0..40), begun)))] {
            let job = Job {
                chunk: chunk(0..1000),
                begun: begun.map(Box::new),
            };
            let reported = std::cell::RefCell::new(Vec::new());
            let report = |work| {
                let Work::Begun(chunk, tossed) = work else {
                    panic!("a chunk that is not finished")
                };
                reported.borrow_mut().push((chunk, tossed));
                true
            };
            let goes_on = toss(&shared, job, &mut Pace::new(Instant::now()), report);
            assert!(!goes_on.unwrap());
            assert!(reported.into_inner().into_iter().eq(expected));
        }
    }

    #[test]
    fn a_thread_that_panics_stops_the_others() {
        for panics in [false, true] {
            let broken = AtomicBool::new(false);
            let ended = thread::scope(|scope| {
                let worker = scope.spawn(|| {
                    let _stop_on_panic = StopOnPanic(&broken);
                    // silent, as no message is asked for
                    if panics {
                        std::panic::resume_unwind(Box::new(()));
                    }
                });
                worker.join()
            });
            assert_eq!((ended.is_err(), broken.load(Relaxed)), (panics, panics));
        }
    }
}

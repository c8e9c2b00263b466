//! Threads that execute chunks, and the one that stores their results.

use super::chunk::compute_chunk;
use super::made::Made;
use super::schedule::{Next, Schedule};
use super::{Chunk, ProgressSink, RunError};
use crate::plan::Plan;
use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

/// How many finished chunks may wait for the disk, and how many at most are stored at once.
const BATCH: usize = 4096;
/// How long an idle worker waits before it checks whether it should stop.
const IDLE_WAIT: Duration = Duration::from_millis(50);

type Done = Result<Made, RunError>;

/// Stores finished chunks, a few at a time.
pub(super) type Store<'a> = &'a dyn Fn(&[Made]) -> Result<(), RunError>;

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

    fn next_chunk(&self) -> Option<Chunk> {
        let mut schedule = self.schedule();
        while self.should_continue() {
            match schedule.next() {
                Next::Chunk(chunk) => return Some(chunk),
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
    while let Some(chunk) = shared.next_chunk() {
        let one = NonZeroUsize::MIN;
        let done = match compute_chunk(shared.plan, chunk, one, || shared.should_continue()) {
            Ok(Some(made)) => {
                shared.schedule().complete(&made.chunk, &made.result);
                shared.changed.notify_all();
                Ok(made)
            }
            Ok(None) => return,
            Err(error) => Err(error),
        };
        if sender.send(done).is_err() {
            return;
        }
    }
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
                Ok(made) => stored.push(made),
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

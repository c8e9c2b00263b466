//! Threads that do chunks, and the one that keeps what they finish.

use super::chunk::do_chunk_while;
use super::piece::Piece;
use super::schedule::{Next, Schedule};
use super::{Chunk, ProgressSink, RunError};
use crate::plan::Plan;
use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

/// Finished chunks that may wait for the disk, and the most that are stored together.
const BATCH: usize = 64;
/// How long a worker without work sleeps before it looks whether it should stop.
const NAP: Duration = Duration::from_millis(50);

type Done = Result<(Chunk, Piece), RunError>;

/// Where finished chunks are kept, a few at a time.
pub(super) type Keep<'a> = &'a dyn Fn(&[(Chunk, Piece)]) -> Result<(), RunError>;

/// What the threads share.
struct Floor<'a, 'p> {
    plan: &'p Plan,
    schedule: Mutex<Schedule<'p>>,
    /// A chunk came back: there may be new work.
    changed: Condvar,
    /// The user wants to stop.
    cancel: &'a AtomicBool,
    /// Something went wrong: there is no use in going on.
    broken: AtomicBool,
}

impl<'p> Floor<'_, 'p> {
    fn go_on(&self) -> bool {
        !self.cancel.load(Relaxed) && !self.broken.load(Relaxed)
    }

    /// Nothing panics while it holds the lock except where the whole run is lost anyway.
    fn schedule(&self) -> MutexGuard<'_, Schedule<'p>> {
        self.schedule.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn next_chunk(&self) -> Option<Chunk> {
        let mut schedule = self.schedule();
        while self.go_on() {
            match schedule.next() {
                Next::Chunk(chunk) => return Some(chunk),
                Next::Done => return None,
                Next::Wait => {
                    let woken = self.changed.wait_timeout(schedule, NAP);
                    schedule = woken.unwrap_or_else(PoisonError::into_inner).0;
                }
            }
        }
        None
    }
}

/// Stops everybody when its thread panics, so that the panic is heard at once.
struct Alarm<'a>(&'a AtomicBool);

impl Drop for Alarm<'_> {
    fn drop(&mut self) {
        if thread::panicking() {
            self.0.store(true, Relaxed);
        }
    }
}

/// Does all chunks of the schedule, or those that are done before `cancel` is set, and gives the
/// schedule back. Every piece it counts has been kept.
pub(super) fn work_off<'p>(
    plan: &'p Plan,
    schedule: Schedule<'p>,
    keep: Keep<'_>,
    threads: NonZeroUsize,
    cancel: &AtomicBool,
    sink: &dyn ProgressSink,
) -> Result<Schedule<'p>, RunError> {
    let floor = Floor {
        plan,
        schedule: Mutex::new(schedule),
        changed: Condvar::new(),
        cancel,
        broken: AtomicBool::new(false),
    };
    thread::scope(|scope| {
        let _alarm = Alarm(&floor.broken);
        let (sender, receiver) = sync_channel(BATCH);
        let mut started = Ok(());
        for _ in 0..threads.get() {
            let (sender, floor) = (sender.clone(), &floor);
            let worker = thread::Builder::new().spawn_scoped(scope, move || work(floor, &sender));
            if let Err(error) = worker {
                floor.broken.store(true, Relaxed);
                started = Err(RunError::Thread(error));
                break;
            }
        }
        drop(sender);
        let stored = store(&floor, &receiver, keep, sink);
        if stored.is_err() {
            floor.broken.store(true, Relaxed);
        }
        started.and(stored)
    })?;
    Ok(floor
        .schedule
        .into_inner()
        .unwrap_or_else(PoisonError::into_inner))
}

fn work(floor: &Floor<'_, '_>, sender: &SyncSender<Done>) {
    let _alarm = Alarm(&floor.broken);
    while let Some(chunk) = floor.next_chunk() {
        let done = match do_chunk_while(floor.plan, &chunk, || floor.go_on()) {
            Ok(Some(piece)) => {
                floor.schedule().complete(&chunk, &piece);
                floor.changed.notify_all();
                Ok((chunk, piece))
            }
            Ok(None) => return,
            Err(error) => Err(error),
        };
        if sender.send(done).is_err() {
            return;
        }
    }
}

/// Stores what arrives until all workers are gone. Its own thread, so that no worker waits for
/// the disk.
fn store(
    floor: &Floor<'_, '_>,
    receiver: &Receiver<Done>,
    keep: Keep<'_>,
    sink: &dyn ProgressSink,
) -> Result<(), RunError> {
    while let Ok(first) = receiver.recv() {
        let batch = std::iter::once(first)
            .chain(receiver.try_iter())
            .take(BATCH);
        let (mut stored, mut failed) = (Vec::new(), None);
        for done in batch {
            match done {
                Ok(chunk) => stored.push(chunk),
                Err(error) => failed = failed.or(Some(error)),
            }
        }
        keep(&stored)?;
        if let Some(error) = failed {
            return Err(error);
        }
        sink.progress(&floor.schedule().progress());
    }
    Ok(())
}

//! Filling arrays from several threads, part by part.

use crate::supervise::Supervision;
use std::io;
use std::panic::resume_unwind;
use std::sync::atomic::Ordering::Relaxed;
use std::sync::{Mutex, PoisonError};
use std::thread;

/// Longest part: some milliseconds of the fastest tosses.
const MAX_PART: usize = 1 << 14;
/// Least number of parts per worker, so that all workers finish at about the same time.
const MIN_PARTS_PER_WORKER: usize = 16;

/// Arrays that can be split in two, like slices.
pub(crate) trait Splittable: Sized + Default + Send {
    /// Number of elements.
    fn len(&self) -> usize;

    /// Splits off the first `n` elements.
    fn split(self, n: usize) -> (Self, Self);
}

/// The part that remains to be filled, and the index of its first element.
struct Remaining<S> {
    at: usize,
    part: S,
}

/// Fills `whole` on `workers` threads: `fill` gets the index at which a part starts, and the part.
/// Stops early, without filling the rest, after an error or when told to by the supervisor.
pub(crate) fn fill_in_parallel<S: Splittable, E: Send + From<io::Error>>(
    whole: S,
    workers: usize,
    supervision: &Supervision,
    fill: impl Fn(usize, S) -> Result<(), E> + Sync,
) -> Result<(), E> {
    let len = whole.len();
    supervision.planned.store(len as u64, Relaxed);
    let max_len = (len / (workers * MIN_PARTS_PER_WORKER)).clamp(1, MAX_PART);
    let left = Mutex::new(Remaining { at: 0, part: whole });
    let work = || -> Result<(), E> {
        while let Some((at, part)) = take(&left, max_len).filter(|_| supervision.may_continue()) {
            let len = part.len() as u64;
            fill(at, part).inspect_err(|_| supervision.stop.store(true, Relaxed))?;
            supervision.done.fetch_add(len, Relaxed);
        }
        Ok(())
    };
    thread::scope(|scope| {
        let mut helpers = Vec::new();
        for _ in 1..workers {
            let helper = thread::Builder::new().spawn_scoped(scope, work);
            helpers.push(helper.inspect_err(|_| supervision.stop.store(true, Relaxed))?);
        }
        let mut done = work();
        for helper in helpers {
            done = done.and(helper.join().unwrap_or_else(|panic| resume_unwind(panic)));
        }
        done
    })
}

fn take<S: Splittable>(left: &Mutex<Remaining<S>>, max_len: usize) -> Option<(usize, S)> {
    let mut left = left.lock().unwrap_or_else(PoisonError::into_inner);
    let n = max_len.min(left.part.len());
    if n == 0 {
        return None;
    }
    let (now, later) = std::mem::take(&mut left.part).split(n);
    left.part = later;
    let at = left.at;
    left.at += n;
    Some((at, now))
}

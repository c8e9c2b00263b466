//! Arrays that several threads fill, each a stretch of them at a time.

use crate::supervise::Desk;
use std::io;
use std::panic::resume_unwind;
use std::sync::atomic::Ordering::Relaxed;
use std::sync::{Mutex, PoisonError};
use std::thread;

/// Longest stretch: some milliseconds of the quickest tosses.
const LONGEST: usize = 1 << 14;
/// Stretches a worker gets at least, so that all end at about the same time.
const SHARE: usize = 16;

/// What can be cut in two, as slices can.
pub(crate) trait Stretch: Sized + Default + Send {
    /// How many places it has.
    fn places(&self) -> usize;

    /// Cuts off the first `n` places.
    fn split(self, n: usize) -> (Self, Self);
}

/// What is left to fill, and how much is not.
struct Left<S> {
    at: usize,
    stretch: S,
}

/// Has `workers` threads fill all of `whole`: `fill` is told the place at which a stretch begins. Ends
/// early, without filling the rest, if it fails or the desk says so.
pub(crate) fn share_out<S: Stretch, E: Send + From<io::Error>>(
    whole: S,
    workers: usize,
    desk: &Desk,
    fill: impl Fn(usize, S) -> Result<(), E> + Sync,
) -> Result<(), E> {
    let places = whole.places();
    desk.planned.store(places as u64, Relaxed);
    let longest = (places / (workers * SHARE)).clamp(1, LONGEST);
    let left = Mutex::new(Left {
        at: 0,
        stretch: whole,
    });
    let work = || -> Result<(), E> {
        while let Some((at, stretch)) = take(&left, longest).filter(|_| desk.go_on()) {
            let places = stretch.places() as u64;
            fill(at, stretch).inspect_err(|_| desk.stop.store(true, Relaxed))?;
            desk.done.fetch_add(places, Relaxed);
        }
        Ok(())
    };
    thread::scope(|scope| {
        let mut hands = Vec::new();
        for _ in 1..workers {
            let hand = thread::Builder::new().spawn_scoped(scope, work);
            hands.push(hand.inspect_err(|_| desk.stop.store(true, Relaxed))?);
        }
        let mut done = work();
        for hand in hands {
            done = done.and(hand.join().unwrap_or_else(|panic| resume_unwind(panic)));
        }
        done
    })
}

fn take<S: Stretch>(left: &Mutex<Left<S>>, longest: usize) -> Option<(usize, S)> {
    let mut left = left.lock().unwrap_or_else(PoisonError::into_inner);
    let n = longest.min(left.stretch.places());
    if n == 0 {
        return None;
    }
    let (now, later) = std::mem::take(&mut left.stretch).split(n);
    left.stretch = later;
    let at = left.at;
    left.at += n;
    Some((at, now))
}

//! Tosses on all cores, counted in memory.

use crate::QuestionError;
use coinmc::plan::Plan;
use coinmc::run::{TossSource, for_each_outcome, stream};
use coinmc_core::Face;
use std::num::NonZeroUsize;
use std::ops::Range;
use std::panic::resume_unwind;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;

/// Tosses of one piece of work: some 0.1 s of the longest.
const PIECE: u64 = 256;

/// Who tosses, and whom to tell.
#[derive(Clone, Copy)]
pub struct Workers<'a> {
    /// Threads; `None` for one per core.
    pub threads: Option<NonZeroUsize>,
    /// Set it (from another thread or a signal) to stop within about 0.1 s.
    pub cancel: &'a AtomicBool,
    /// Is told whenever tosses have been made, and how many.
    pub made: &'a (dyn Fn(u64) + Sync),
}

/// A point of a plan.
#[derive(Debug, Clone, Copy)]
pub(crate) struct At<'a> {
    pub(crate) plan: &'a Plan,
    pub(crate) point: usize,
}

/// A part of the work with this index.
struct Piece {
    work: usize,
    tosses: Range<u64>,
}

/// Tosses of a pair of points by the face at the first and the face at the second (3 for none).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Changes([u64; 16]);

impl Changes {
    fn with(&self, first: impl Fn(usize) -> bool, second: impl Fn(usize) -> bool) -> u64 {
        let tosses = self.0.iter().enumerate();
        let counted = tosses.filter(|(place, _)| first(place / 4) && second(place % 4));
        counted.map(|(_, tosses)| tosses).sum()
    }

    /// All tosses.
    pub(crate) fn tosses(&self) -> u64 {
        self.0.iter().sum()
    }

    /// Tosses whose face differs.
    pub(crate) fn changed(&self) -> u64 {
        let same: u64 = (0..4).map(|face| self.0[5 * face]).sum();
        self.tosses() - same
    }

    /// Share of the tosses that show a face at the first point.
    pub(crate) fn share(&self, face: Face) -> f64 {
        self.with(|first| first == face as usize, |_| true) as f64 / self.tosses() as f64
    }

    /// How far the probability of a face is higher at the second point, and the standard error of that, by
    /// the variance of paired proportions (McNemar, Psychometrika 12 (1947) 153).
    pub(crate) fn difference(&self, face: Face) -> (f64, f64) {
        let is = |shown| shown == face as usize;
        let gained = self.with(|first| !is(first), is) as f64;
        let lost = self.with(is, |second| !is(second)) as f64;
        let n = self.tosses() as f64;
        let change = (gained - lost) / n;
        // one more change of either kind, so that no change seen does not mean no error
        let variance = (gained + lost + 1.0 - (gained - lost) * change) / (n * n);
        (change, variance.sqrt())
    }
}

impl Workers<'_> {
    /// Counts the faces of all work: heads, tails, side and undecided of each.
    pub(crate) fn count(
        &self,
        work: &[(At<'_>, Range<u64>)],
    ) -> Result<Vec<[u64; 4]>, QuestionError> {
        let ranges: Vec<_> = work.iter().map(|(_, tosses)| tosses.clone()).collect();
        self.each_piece(&ranges, &|index, tosses| {
            let mut counts = [0; 4];
            self.faces(work[index].0, tosses, &mut |_, face| counts[face] += 1)?;
            Ok(counts)
        })
    }

    /// Tosses pairs of points with the same random numbers.
    pub(crate) fn compare(
        &self,
        pairs: &[[At<'_>; 2]],
        tosses: Range<u64>,
    ) -> Result<Vec<Changes>, QuestionError> {
        let ranges = vec![tosses; pairs.len()];
        let tables = self.each_piece(&ranges, &|index, tosses| {
            let [first, second] = pairs[index];
            let start = tosses.start;
            let place = |toss: u64| usize::try_from(toss - start).expect("a piece is small");
            let mut before = vec![3; place(tosses.end)];
            self.faces(first, tosses.clone(), &mut |toss, shown| {
                before[place(toss)] = shown;
            })?;
            let mut table = [0; 16];
            self.faces(second, tosses, &mut |toss, shown| {
                table[4 * before[place(toss)] + shown] += 1;
            })?;
            Ok(table)
        })?;
        Ok(tables.into_iter().map(Changes).collect())
    }

    /// Calls `visit` with the number and the face (3 for none) of each toss.
    fn faces(
        &self,
        at: At<'_>,
        tosses: Range<u64>,
        visit: &mut dyn FnMut(u64, usize),
    ) -> Result<(), QuestionError> {
        // all points share their random numbers, as with `paired = true`
        let stream = stream(at.plan, 0);
        let source = TossSource::Drawn(&stream);
        let made = tosses.end - tosses.start;
        let go_on = || !self.cancel.load(Ordering::Relaxed);
        for_each_outcome(
            &at.plan.points[at.point],
            source,
            tosses,
            |toss, outcome| {
                visit(toss, outcome.face().map_or(3, |face| face as usize));
                go_on()
            },
        )
        .map_err(QuestionError::Engine)?;
        if !go_on() {
            return Err(QuestionError::Stopped);
        }
        (self.made)(made);
        Ok(())
    }

    /// Divides ranges of tosses among the threads, and adds up what the pieces of each give.
    fn each_piece<const N: usize>(
        &self,
        ranges: &[Range<u64>],
        compute: &(dyn Fn(usize, Range<u64>) -> Result<[u64; N], QuestionError> + Sync),
    ) -> Result<Vec<[u64; N]>, QuestionError> {
        let pieces: Vec<Piece> = ranges.iter().enumerate().flat_map(pieces).collect();
        let next = AtomicUsize::new(0);
        let sums = Mutex::new(vec![[0; N]; ranges.len()]);
        let toss = || {
            while let Some(piece) = pieces.get(next.fetch_add(1, Ordering::Relaxed)) {
                let counts = compute(piece.work, piece.tosses.clone())?;
                let mut sums = sums.lock().expect("no thread panics while it adds");
                for (sum, count) in sums[piece.work].iter_mut().zip(counts) {
                    *sum += count;
                }
            }
            Ok(())
        };
        let threads = self
            .threads
            .or_else(|| thread::available_parallelism().ok());
        let threads = threads.map_or(1, NonZeroUsize::get).min(pieces.len());
        thread::scope(|scope| {
            let mut handles = vec![];
            for _ in 0..threads {
                let handle = thread::Builder::new().spawn_scoped(scope, toss);
                handles.push(handle.map_err(QuestionError::Thread)?);
            }
            let join = |handle: thread::ScopedJoinHandle<'_, _>| {
                handle.join().unwrap_or_else(|panic| resume_unwind(panic))
            };
            // all are joined before the first error is returned
            let results: Vec<Result<(), QuestionError>> = handles.into_iter().map(join).collect();
            results.into_iter().collect::<Result<(), _>>()
        })?;
        Ok(sums.into_inner().expect("no thread panics while it adds"))
    }
}

fn pieces((work, range): (usize, &Range<u64>)) -> impl Iterator<Item = Piece> + use<> {
    let (start, end) = (range.start, range.end);
    (0..(end - start).div_ceil(PIECE)).map(move |piece| {
        let first = start + piece * PIECE;
        Piece {
            work,
            tosses: first..end.min(first + PIECE),
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 80 tosses gain the side, 50 lose it, 30 only turn over.
    #[test]
    fn changes_are_those_of_one_face() {
        let mut table = [0; 16];
        table[0] = 5000;
        (table[4], table[2], table[6]) = (30, 60, 20);
        (table[10], table[8], table[11]) = (4840, 40, 10);
        let changes = Changes(table);
        assert_eq!((changes.tosses(), changes.changed()), (10_000, 160));
        assert!((changes.share(Face::Side) - 0.489).abs() < 1e-12);
        let (change, error) = changes.difference(Face::Side);
        assert!((change - 0.003).abs() < 1e-12);
        assert!((error - (131.0_f64 - 0.09).sqrt() / 1e4).abs() < 1e-12);
    }
}

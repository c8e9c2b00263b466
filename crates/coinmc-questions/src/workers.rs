//! Tosses on all cores, counted in memory.

use crate::QuestionError;
use crate::changes::{Changes, ENDS, PAIRS, UNDECIDED, end_of, table};
use coinmc::plan::{Plan, Point};
use coinmc::run::{TossSource, for_each_outcome, stream};
use coinmc_core::{Outcome, Stream};
use std::num::NonZeroUsize;
use std::ops::Range;
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;

/// Tosses of one piece of work: some 0.1 s of the longest.
const PIECE: u64 = 256;
/// Pieces that are handed out before more are cut.
const ROUND: usize = 1 << 16;

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

impl Workers<'_> {
    /// Counts the ends of all work.
    pub(crate) fn count(
        &self,
        work: &[(At<'_>, Range<u64>)],
    ) -> Result<Vec<[u64; ENDS]>, QuestionError> {
        let ranges: Vec<_> = work.iter().map(|(_, tosses)| tosses.clone()).collect();
        self.each_piece(&ranges, &|index, tosses| {
            let mut counts = [0; ENDS];
            self.ends(work[index].0, tosses, &mut |_, end| counts[end] += 1)?;
            Ok(counts)
        })
    }

    /// Counts the ends of tosses of a plan's first point: heads, tails, side, undecided and left.
    ///
    /// # Errors
    /// As [`outcomes`](Self::outcomes), or that no thread can be started.
    pub fn count_first(
        &self,
        plan: &Plan,
        tosses: Range<u64>,
    ) -> Result<[u64; ENDS], QuestionError> {
        Ok(self.count(&[(At { plan, point: 0 }, tosses)])?[0])
    }

    /// Tosses pairs of points with the same random numbers.
    pub(crate) fn compare(
        &self,
        pairs: &[[At<'_>; 2]],
        tosses: Range<u64>,
    ) -> Result<Vec<Changes>, QuestionError> {
        self.compare_drawn(pairs, tosses, &|pair| pair.map(|at| stream(at.plan, 0)))
    }

    /// Tosses pairs of points with the random numbers that the first has in a run of its plan.
    pub(crate) fn compare_runs(
        &self,
        pairs: &[[At<'_>; 2]],
        tosses: Range<u64>,
    ) -> Result<Vec<Changes>, QuestionError> {
        self.compare_drawn(pairs, tosses, &|[first, _]| {
            [(); 2].map(|()| stream(first.plan, first.point))
        })
    }

    /// Tosses pairs of points, each with the random numbers that are chosen for it.
    fn compare_drawn(
        &self,
        pairs: &[[At<'_>; 2]],
        tosses: Range<u64>,
        streams: &(dyn Fn([At<'_>; 2]) -> [Stream; 2] + Sync),
    ) -> Result<Vec<Changes>, QuestionError> {
        let ranges = vec![tosses; pairs.len()];
        let tables = self.each_piece(&ranges, &|index, tosses| {
            let [first, second] = pairs[index];
            let [of_first, of_second] = streams(pairs[index]);
            let before = self.ends_drawn(first, &of_first, tosses.clone())?;
            let after = self.ends_drawn(second, &of_second, tosses)?;
            Ok(table(&before, &after))
        })?;
        Ok(tables.into_iter().map(Changes::new).collect())
    }

    /// Tosses one point and others with the same random numbers.
    pub(crate) fn compare_with(
        &self,
        first: At<'_>,
        others: &[At<'_>],
        tosses: Range<u64>,
    ) -> Result<Vec<Changes>, QuestionError> {
        let tables = |piece: &Piece| {
            let before = self.ends_of(first, piece.tosses.clone())?;
            let others = others.iter();
            let tables = others.map(|&other| self.table(&before, other, piece.tosses.clone()));
            tables.collect::<Result<Vec<_>, _>>()
        };
        let mut sums = vec![[0; PAIRS]; others.len()];
        let at_once = (ROUND / others.len().max(1)).max(1);
        self.in_rounds(pieces((0, &tosses)), at_once, &tables, &mut |_, tables| {
            for (sum, table) in sums.iter_mut().zip(&tables) {
                add(sum, table);
            }
        })?;
        Ok(sums.into_iter().map(Changes::new).collect())
    }

    /// The end of each toss.
    fn ends_of(&self, at: At<'_>, tosses: Range<u64>) -> Result<Vec<usize>, QuestionError> {
        // all points share their random numbers, as with `paired = true`
        self.ends_drawn(at, &stream(at.plan, 0), tosses)
    }

    /// The same of tosses with these random numbers.
    fn ends_drawn(
        &self,
        at: At<'_>,
        stream: &Stream,
        tosses: Range<u64>,
    ) -> Result<Vec<usize>, QuestionError> {
        let start = tosses.start;
        let place = |toss: u64| usize::try_from(toss - start).expect("a piece is small");
        let mut ends = vec![UNDECIDED; place(tosses.end)];
        let point = &at.plan.points[at.point];
        self.outcomes(point, stream, tosses, &mut |toss, outcome| {
            ends[place(toss)] = end_of(outcome);
        })?;
        Ok(ends)
    }

    /// Tosses by their end before and their end at another point.
    fn table(
        &self,
        before: &[usize],
        at: At<'_>,
        tosses: Range<u64>,
    ) -> Result<[u64; PAIRS], QuestionError> {
        Ok(table(before, &self.ends_of(at, tosses)?))
    }

    /// Calls `visit` with the number and the end of each toss.
    pub(crate) fn ends(
        &self,
        at: At<'_>,
        tosses: Range<u64>,
        visit: &mut dyn FnMut(u64, usize),
    ) -> Result<(), QuestionError> {
        // all points share their random numbers, as with `paired = true`
        let stream = stream(at.plan, 0);
        let point = &at.plan.points[at.point];
        self.outcomes(point, &stream, tosses, &mut |toss, outcome| {
            visit(toss, end_of(outcome));
        })
    }

    /// Calls `visit` with the number and the outcome of each toss at a point, on this thread.
    ///
    /// # Errors
    /// [`QuestionError::Engine`] if the engine rejects its settings, [`QuestionError::Stopped`].
    pub fn outcomes(
        &self,
        point: &Point,
        stream: &Stream,
        tosses: Range<u64>,
        visit: &mut dyn FnMut(u64, &Outcome),
    ) -> Result<(), QuestionError> {
        let made = tosses.end - tosses.start;
        let go_on = || !self.cancel.load(Ordering::Relaxed);
        for_each_outcome(point, TossSource::Drawn(stream), tosses, |toss, outcome| {
            visit(toss, outcome);
            go_on()
        })
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
        let all = ranges.iter().enumerate().flat_map(pieces);
        let mut sums = vec![[0; N]; ranges.len()];
        let compute = |piece: &Piece| compute(piece.work, piece.tosses.clone());
        self.in_rounds(all, ROUND, &compute, &mut |piece, counts| {
            add(&mut sums[piece.work], &counts);
        })?;
        Ok(sums)
    }

    /// Computes pieces on all threads, so many before their results are taken: 1e12 tosses have four thousand million
    /// pieces, and not all of their results fit into memory.
    fn in_rounds<T: Send>(
        &self,
        mut pieces: impl Iterator<Item = Piece>,
        at_once: usize,
        compute: &(dyn Fn(&Piece) -> Result<T, QuestionError> + Sync),
        take: &mut dyn FnMut(&Piece, T),
    ) -> Result<(), QuestionError> {
        loop {
            let round: Vec<Piece> = pieces.by_ref().take(at_once).collect();
            if round.is_empty() {
                return Ok(());
            }
            let results = self.each(round.len(), &|index| compute(&round[index]))?;
            for (piece, result) in round.iter().zip(results) {
                take(piece, result);
            }
        }
    }

    /// Computes pieces of work on all threads, in this order as far as there are threads.
    ///
    /// # Errors
    /// The first error of a piece, or that no thread can be started.
    pub fn each<T: Send, E: Send + From<QuestionError>>(
        &self,
        pieces: usize,
        compute: &(dyn Fn(usize) -> Result<T, E> + Sync),
    ) -> Result<Vec<T>, E> {
        let next = AtomicUsize::new(0);
        let work = || -> Result<Vec<(usize, T)>, E> {
            let mut done = vec![];
            loop {
                let piece = next.fetch_add(1, Ordering::Relaxed);
                if piece >= pieces {
                    return Ok(done);
                }
                done.push((piece, compute(piece)?));
            }
        };
        let threads = self
            .threads
            .or_else(|| thread::available_parallelism().ok());
        let threads = threads.map_or(1, NonZeroUsize::get).min(pieces);
        // a WebAssembly module has no threads: its only one does the work
        let results = if threads < 2 {
            vec![work()]
        } else {
            thread::scope(|scope| {
                let mut handles = vec![];
                for _ in 0..threads {
                    let handle = thread::Builder::new().spawn_scoped(scope, work);
                    handles.push(handle.map_err(QuestionError::Thread)?);
                }
                let join = |handle: thread::ScopedJoinHandle<'_, _>| {
                    handle.join().unwrap_or_else(|panic| resume_unwind(panic))
                };
                // all are joined before the first error is returned
                Ok::<Vec<_>, E>(handles.into_iter().map(join).collect())
            })?
        };
        let mut done = vec![];
        for result in results {
            done.extend(result?);
        }
        done.sort_by_key(|(piece, _)| *piece);
        Ok(done.into_iter().map(|(_, result)| result).collect())
    }
}

fn add<const N: usize>(sum: &mut [u64; N], counts: &[u64; N]) {
    for (sum, count) in sum.iter_mut().zip(counts) {
        *sum += count;
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

    /// However many tosses there are, few of their pieces are in memory at a time, and none is lost: three rounds and a
    /// part of one.
    #[test]
    fn pieces_are_cut_as_they_are_needed() {
        let cancel = AtomicBool::new(false);
        let workers = Workers {
            threads: NonZeroUsize::new(2),
            cancel: &cancel,
            made: &|_| (),
        };
        let tosses = 3 * ROUND as u64 * PIECE + 1000;
        let ranges = [5..5 + tosses, 0..7, 0..0];
        let counts = workers.each_piece(&ranges, &|work, tosses| {
            Ok([tosses.end - tosses.start, work as u64])
        });
        let counts = counts.expect("nothing fails");
        assert_eq!(counts[0], [tosses, 0]);
        assert_eq!(counts[1..], [[7, 1], [0, 0]]);
        // begun at once, though all pieces would not fit into memory
        let failing =
            workers.each_piece::<1>(&[0..u64::MAX, 0..0], &|_, _| Err(QuestionError::Stopped));
        assert!(matches!(failing, Err(QuestionError::Stopped)));
    }
}

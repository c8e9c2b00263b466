//! Tosses on all cores, counted in memory.

use crate::interval::normal_quantile;
use crate::seen::Seen;
use crate::{Interval, QuestionError};
use coinmc::plan::{Plan, Point};
use coinmc::run::{TossSource, for_each_outcome, stream};
use coinmc_core::{Face, Outcome, Stream};
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

/// The ends that are told apart: heads, tails, side, undecided and left, as numbers from 0.
pub(crate) const ENDS: usize = 5;
pub(crate) const UNDECIDED: usize = 3;
const LEFT: usize = 4;
const PAIRS: usize = ENDS * ENDS;

/// The number of a toss's end.
fn end_of(outcome: &Outcome) -> usize {
    match outcome.face() {
        Some(face) => face as usize,
        None if outcome.is_undecided() => UNDECIDED,
        None => LEFT,
    }
}

/// Tosses of a pair of points by the end at the first and the end at the second.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Changes([u64; PAIRS]);

impl Changes {
    fn with(&self, first: impl Fn(usize) -> bool, second: impl Fn(usize) -> bool) -> u64 {
        let tosses = self.0.iter().enumerate();
        let counted = tosses.filter(|(place, _)| first(place / ENDS) && second(place % ENDS));
        counted.map(|(_, tosses)| tosses).sum()
    }

    /// All tosses.
    pub(crate) fn tosses(&self) -> u64 {
        self.0.iter().sum()
    }

    /// Tosses whose end differs.
    pub(crate) fn changed(&self) -> u64 {
        let same: u64 = (0..ENDS).map(|end| self.0[(ENDS + 1) * end]).sum();
        self.tosses() - same
    }

    /// Tosses that show a face at the second point only, and at the first only.
    pub(crate) fn of(&self, face: Face) -> (u64, u64) {
        let is = |shown| shown == face as usize;
        let gained = self.with(|first| !is(first), is);
        (gained, self.with(is, |second| !is(second)))
    }

    /// The same if every undecided toss had ended as makes the probability of the face rise least, and most.
    pub(crate) fn extremes_of(&self, face: Face) -> [(u64, u64); 2] {
        let is = |shown| shown == face as usize;
        let may_be = |shown| is(shown) || shown == UNDECIDED;
        let most_gained = self.with(|first| !is(first), may_be);
        let most_lost = self.with(may_be, |second| !is(second));
        let least_gained = self.with(|first| !may_be(first), is);
        let least_lost = self.with(is, |second| !may_be(second));
        [(least_gained, most_lost), (most_gained, least_lost)]
    }

    /// Undecided tosses at the first and at the second point.
    pub(crate) fn undecided(&self) -> [u64; 2] {
        self.ended(UNDECIDED)
    }

    /// Tosses with this end at the first and at the second point.
    fn ended(&self, end: usize) -> [u64; 2] {
        let first = self.with(|first| first == end, |_| true);
        [first, self.with(|_| true, |second| second == end)]
    }

    /// The tosses at the first and at the second point.
    pub(crate) fn seen(&self, face: Face) -> [Seen; 2] {
        let (shown, undecided) = (self.ended(face as usize), self.undecided());
        [0, 1].map(|point: usize| Seen {
            tosses: self.tosses(),
            shown: shown[point],
            undecided: undecided[point],
        })
    }

    /// The mean of the shares of the tosses that show a face at the first and at the second point.
    pub(crate) fn mean_share(&self, face: Face) -> f64 {
        let [first, second] = self.seen(face).map(|seen| seen.share());
        0.5 * (first + second)
    }

    /// How far the probability of a face is higher at the second point, and the standard error of that, by
    /// the variance of paired proportions (McNemar, Psychometrika 12 (1947) 153).
    pub(crate) fn difference(&self, face: Face) -> (f64, f64) {
        difference(self.of(face), self.tosses())
    }

    /// How far the probability of a face is higher at the second point, with an interval that holds whatever
    /// the undecided tosses would have shown.
    pub(crate) fn interval(&self, face: Face, confidence: f64) -> Interval {
        let z = normal_quantile(confidence);
        let [least, most] = self
            .extremes_of(face)
            .map(|counts| difference(counts, self.tosses()));
        Interval {
            value: self.difference(face).0,
            lo: least.0 - z * least.1,
            hi: most.0 + z * most.1,
        }
    }
}

/// The difference of two shares of so many tosses, of which some gained a face and some lost it, and its
/// standard error.
fn difference((gained, lost): (u64, u64), tosses: u64) -> (f64, f64) {
    let [gained, lost, n] = [gained, lost, tosses].map(|tosses| tosses as f64);
    let change = (gained - lost) / n;
    // one more change of either kind, so that no change seen does not mean no error
    let variance = (gained + lost + 1.0 - (gained - lost) * change) / (n * n);
    (change, variance.sqrt())
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
        Ok(tables.into_iter().map(Changes).collect())
    }

    /// Tosses one point and others with the same random numbers.
    pub(crate) fn compare_with(
        &self,
        first: At<'_>,
        others: &[At<'_>],
        tosses: Range<u64>,
    ) -> Result<Vec<Changes>, QuestionError> {
        let pieces: Vec<_> = pieces((0, &tosses)).collect();
        let tables = self.each(pieces.len(), &|index| {
            let tosses = &pieces[index].tosses;
            let before = self.ends_of(first, tosses.clone())?;
            let others = others.iter();
            let tables = others.map(|&other| self.table(&before, other, tosses.clone()));
            tables.collect::<Result<Vec<_>, _>>()
        })?;
        let mut sums = vec![[0; PAIRS]; others.len()];
        for tables in &tables {
            for (sum, table) in sums.iter_mut().zip(tables) {
                add(sum, table);
            }
        }
        Ok(sums.into_iter().map(Changes).collect())
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
        let mut left = ranges.iter().enumerate().flat_map(pieces);
        let mut sums = vec![[0; N]; ranges.len()];
        loop {
            // not all at once: 1e12 tosses have a thousand million pieces
            let round: Vec<Piece> = left.by_ref().take(ROUND).collect();
            if round.is_empty() {
                return Ok(sums);
            }
            let counts = self.each(round.len(), &|index| {
                let piece = &round[index];
                compute(piece.work, piece.tosses.clone())
            })?;
            for (piece, counts) in round.iter().zip(&counts) {
                add(&mut sums[piece.work], counts);
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

/// Tosses by their end at one point and their end at another.
fn table(before: &[usize], after: &[usize]) -> [u64; PAIRS] {
    let mut table = [0; PAIRS];
    for (before, after) in before.iter().zip(after) {
        table[ENDS * before + after] += 1;
    }
    table
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

    fn changes(table: [[u64; ENDS]; ENDS]) -> Changes {
        let mut pairs = table.concat().into_iter();
        Changes([(); PAIRS].map(|()| pairs.next().expect("a pair of ends")))
    }

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

    /// 80 tosses gain the side, 50 lose it, 30 only turn over.
    #[test]
    fn changes_are_those_of_one_face() {
        let [heads, tails, side] = [0, 1, 2];
        let mut table = [[0; ENDS]; ENDS];
        (table[heads][heads], table[side][side]) = (5000, 4840);
        (table[tails][heads], table[heads][side], table[tails][side]) = (30, 60, 20);
        (table[side][heads], table[side][LEFT]) = (40, 10);
        (table[UNDECIDED][UNDECIDED], table[LEFT][LEFT]) = (3, 7);
        let changes = changes(table);
        assert_eq!((changes.tosses(), changes.changed()), (10_010, 160));
        assert_eq!(changes.seen(Face::Side)[0].undecided, 3);
        assert!((changes.mean_share(Face::Side) - 4905.0 / 10_010.0).abs() < 1e-12);
        let (change, error) = changes.difference(Face::Side);
        assert!((change - 30.0 / 10_010.0).abs() < 1e-12);
        assert!((error - (131.0_f64 - 900.0 / 10_010.0).sqrt() / 10_010.0).abs() < 1e-12);
    }

    /// Of 1,000 tosses 100 are undecided at both points and may have gained the side, or lost it; 20 at the first,
    /// which show it at the second and may have shown it before; 30 at the second, which showed heads.
    #[test]
    fn undecided_tosses_may_have_changed_either_way() {
        let [heads, side] = [0, 2];
        let mut table = [[0; ENDS]; ENDS];
        (table[heads][heads], table[side][side]) = (500, 340);
        (table[heads][side], table[side][heads]) = (6, 4);
        table[UNDECIDED][UNDECIDED] = 100;
        (table[UNDECIDED][side], table[heads][UNDECIDED]) = (20, 30);
        let changes = changes(table);
        assert_eq!(changes.undecided(), [120, 130]);
        assert_eq!(changes.of(Face::Side), (26, 4));
        assert_eq!(changes.extremes_of(Face::Side), [(6, 104), (156, 4)]);
        let Interval { value, lo, hi } = changes.interval(Face::Side, 0.95);
        assert!((value - 0.022).abs() < 1e-12);
        assert!(
            lo < -0.098 && lo > -0.12 && hi > 0.152 && hi < 0.18,
            "{lo} {hi}"
        );
        table[UNDECIDED] = [0; ENDS];
        table[heads][UNDECIDED] = 0;
        let decided = self::changes(table);
        assert_eq!(decided.extremes_of(Face::Side), [(6, 4); 2]);
        let (change, error) = decided.difference(Face::Side);
        let found = decided.interval(Face::Side, 0.95);
        assert!((found.hi - change - 1.959_963_984_540_054 * error).abs() < 1e-12);
        assert!((found.hi + found.lo - 2.0 * change).abs() < 1e-12);
    }
}

//! Tosses of a pair of points, by how they end at either.

use crate::Interval;
use crate::interval::normal_quantile;
use crate::seen::Seen;
use coinmc_core::{Face, Outcome};

/// The ends that are told apart: heads, tails, side, undecided and left, as numbers from 0.
pub(crate) const ENDS: usize = 5;
pub(crate) const UNDECIDED: usize = 3;
const LEFT: usize = 4;
pub(crate) const PAIRS: usize = ENDS * ENDS;

/// The number of a toss's end.
pub(crate) fn end_of(outcome: &Outcome) -> usize {
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
    /// Of a [`table`], or of several that are added up.
    pub(crate) fn new(pairs: [u64; PAIRS]) -> Self {
        Self(pairs)
    }

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

/// Tosses by their end at one point and their end at another.
pub(crate) fn table(before: &[usize], after: &[usize]) -> [u64; PAIRS] {
    let mut table = [0; PAIRS];
    for (before, after) in before.iter().zip(after) {
        table[ENDS * before + after] += 1;
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    fn changes(table: [[u64; ENDS]; ENDS]) -> Changes {
        let mut pairs = table.concat().into_iter();
        Changes([(); PAIRS].map(|()| pairs.next().expect("a pair of ends")))
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

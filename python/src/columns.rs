//! Columns of tosses in arrays allocated by Python.

use crate::launch::{ROW, write_state};
use crate::share::Splittable;
use coinmc::run::FinishedToss;
use coinmc_core::{Ended, Face, Outcome};
use coinmc_trace::EndKind;

/// Code of a toss without a face, after those of [`Face::ALL`].
const UNDECIDED: u8 = 3;
const LEFT: u8 = 4;

/// The columns to fill, for a range of tosses.
#[derive(Default)]
pub(crate) struct Columns<'a> {
    pub(crate) face: &'a mut [u8],
    pub(crate) details: Option<Details<'a>>,
}

/// The columns besides the face.
pub(crate) struct Details<'a> {
    pub(crate) ended: &'a mut [u8],
    pub(crate) impacts: &'a mut [u32],
    pub(crate) time_s: &'a mut [f64],
    pub(crate) last: &'a mut [f64],
}

impl Splittable for Columns<'_> {
    fn len(&self) -> usize {
        self.face.len()
    }

    fn split(self, n: usize) -> (Self, Self) {
        let (face, later) = self.face.split_at_mut(n);
        let (details, after) = self.details.map(|details| details.split(n)).unzip();
        let later = Self {
            face: later,
            details: after,
        };
        (Self { face, details }, later)
    }
}

impl Details<'_> {
    fn split(self, n: usize) -> (Self, Self) {
        let (ended, later_ended) = self.ended.split_at_mut(n);
        let (impacts, later_impacts) = self.impacts.split_at_mut(n);
        let (time_s, later_time_s) = self.time_s.split_at_mut(n);
        let (last, later_last) = self.last.split_at_mut(n * ROW);
        let now = Self {
            ended,
            impacts,
            time_s,
            last,
        };
        let later = Self {
            ended: later_ended,
            impacts: later_impacts,
            time_s: later_time_s,
            last: later_last,
        };
        (now, later)
    }

    /// Whether all columns have `n` tosses.
    pub(crate) fn has_len(&self, n: usize) -> bool {
        let lengths = [self.ended.len(), self.impacts.len(), self.time_s.len()];
        lengths == [n; 3] && self.last.len() == n * ROW
    }

    /// Writes a toss to index `i`; `from` is the horizontal position of the launch.
    pub(crate) fn write(&mut self, i: usize, toss: &FinishedToss, from: [f64; 2]) {
        self.ended[i] = end_code(&toss.outcome);
        self.impacts[i] = toss.outcome.impacts;
        self.time_s[i] = toss.end.time_s;
        write_state(&toss.end, from, &mut self.last[i * ROW..(i + 1) * ROW]);
    }
}

/// Rows to fill with drawn launches.
#[derive(Default)]
pub(crate) struct Rows<'a>(pub(crate) &'a mut [f64]);

impl Splittable for Rows<'_> {
    fn len(&self) -> usize {
        self.0.len() / ROW
    }

    fn split(self, n: usize) -> (Self, Self) {
        let (now, later) = self.0.split_at_mut(n * ROW);
        (Self(now), Self(later))
    }
}

/// The code of the face.
pub(crate) fn face_code(outcome: &Outcome) -> u8 {
    match outcome.face() {
        Some(Face::Heads) => 0,
        Some(Face::Tails) => 1,
        Some(Face::Side) => 2,
        None if outcome.ended == Ended::Left => LEFT,
        None => UNDECIDED,
    }
}

fn end_code(outcome: &Outcome) -> u8 {
    match EndKind::of(outcome.ended) {
        EndKind::Decided => 0,
        EndKind::TimeLimit => 1,
        EndKind::NeverSettles => 2,
        EndKind::ImpactLimit => 3,
        EndKind::Failed => 4,
        EndKind::Left => 5,
    }
}

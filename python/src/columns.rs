//! What is known of tosses, column by column, in arrays that Python made.

use crate::launch::{ROW, write_state};
use crate::share::Stretch;
use coinmc::run::Seen;
use coinmc_core::{Face, Outcome};
use coinmc_trace::EndKind;

/// Code of a toss without a face, behind those of [`Face::ALL`].
const UNDECIDED: u8 = 3;

/// What is filled, for the tosses of a stretch.
#[derive(Default)]
pub(crate) struct Columns<'a> {
    pub(crate) face: &'a mut [u8],
    pub(crate) rest: Option<Rest<'a>>,
}

/// All that is kept of a toss beside its face.
pub(crate) struct Rest<'a> {
    pub(crate) ended: &'a mut [u8],
    pub(crate) impacts: &'a mut [u32],
    pub(crate) time_s: &'a mut [f64],
    pub(crate) last: &'a mut [f64],
}

impl Stretch for Columns<'_> {
    fn places(&self) -> usize {
        self.face.len()
    }

    fn split(self, n: usize) -> (Self, Self) {
        let (face, later) = self.face.split_at_mut(n);
        let (rest, after) = self.rest.map(|rest| rest.split(n)).unzip();
        let later = Self {
            face: later,
            rest: after,
        };
        (Self { face, rest }, later)
    }
}

impl Rest<'_> {
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
    pub(crate) fn is_of(&self, n: usize) -> bool {
        let lengths = [self.ended.len(), self.impacts.len(), self.time_s.len()];
        lengths == [n; 3] && self.last.len() == n * ROW
    }

    /// Writes a toss into place `i`; `from` is where the coin was let go.
    pub(crate) fn write(&mut self, i: usize, seen: &Seen, from: [f64; 2]) {
        self.ended[i] = end_code(&seen.outcome);
        self.impacts[i] = seen.outcome.impacts;
        self.time_s[i] = seen.end.time_s;
        write_state(&seen.end, from, &mut self.last[i * ROW..(i + 1) * ROW]);
    }
}

/// Rows of launches that are drawn.
#[derive(Default)]
pub(crate) struct Rows<'a>(pub(crate) &'a mut [f64]);

impl Stretch for Rows<'_> {
    fn places(&self) -> usize {
        self.0.len() / ROW
    }

    fn split(self, n: usize) -> (Self, Self) {
        let (now, later) = self.0.split_at_mut(n * ROW);
        (Self(now), Self(later))
    }
}

/// The code of what shows.
pub(crate) fn face_code(outcome: &Outcome) -> u8 {
    match outcome.face() {
        Some(Face::Heads) => 0,
        Some(Face::Tails) => 1,
        Some(Face::Side) => 2,
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
    }
}

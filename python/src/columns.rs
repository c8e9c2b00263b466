//! Columns of tosses in arrays allocated by Python.

use crate::launch::{ROW, Start, write_state};
use crate::share::Splittable;
use coinmc::run::FinishedToss;
use coinmc_core::{Ended, Face, Outcome, TableTilt};
use coinmc_trace::EndKind;

/// Code of a toss without a face, after those of [`Face::ALL`].
const UNDECIDED: u8 = 3;
const LEFT: u8 = 4;

/// The columns to fill, for a range of tosses.
pub(crate) enum Columns<'a> {
    /// Faces alone.
    Faces(&'a mut [u8]),
    /// What the lanes of an engine know.
    Outcomes(Outcomes<'a>),
    /// What only the scalar path knows.
    Ends(Ends<'a>),
}

/// Outcomes of tosses.
pub(crate) struct Outcomes<'a> {
    face: &'a mut [u8],
    ended: &'a mut [u8],
    impacts: &'a mut [u32],
}

/// Times and states at the end of tosses.
pub(crate) struct Ends<'a> {
    time_s: &'a mut [f64],
    last: &'a mut [f64],
}

impl Default for Columns<'_> {
    fn default() -> Self {
        Self::Faces(&mut [])
    }
}

impl Splittable for Columns<'_> {
    fn len(&self) -> usize {
        match self {
            Self::Faces(face) => face.len(),
            Self::Outcomes(outcomes) => outcomes.face.len(),
            Self::Ends(ends) => ends.time_s.len(),
        }
    }

    fn split(self, n: usize) -> (Self, Self) {
        match self {
            Self::Faces(face) => {
                let (now, later) = face.split_at_mut(n);
                (Self::Faces(now), Self::Faces(later))
            }
            Self::Outcomes(outcomes) => {
                let (now, later) = outcomes.split(n);
                (Self::Outcomes(now), Self::Outcomes(later))
            }
            Self::Ends(ends) => {
                let (now, later) = ends.split(n);
                (Self::Ends(now), Self::Ends(later))
            }
        }
    }
}

impl<'a> Outcomes<'a> {
    /// The columns; `None` if they are not equally long.
    pub(crate) fn new(
        face: &'a mut [u8],
        ended: &'a mut [u8],
        impacts: &'a mut [u32],
    ) -> Option<Self> {
        let equal = ended.len() == face.len() && impacts.len() == face.len();
        equal.then_some(Self {
            face,
            ended,
            impacts,
        })
    }

    fn split(self, n: usize) -> (Self, Self) {
        let (face, later_face) = self.face.split_at_mut(n);
        let (ended, later_ended) = self.ended.split_at_mut(n);
        let (impacts, later_impacts) = self.impacts.split_at_mut(n);
        let now = Self {
            face,
            ended,
            impacts,
        };
        let later = Self {
            face: later_face,
            ended: later_ended,
            impacts: later_impacts,
        };
        (now, later)
    }

    /// Writes an outcome to index `i`.
    pub(crate) fn write(&mut self, i: usize, outcome: &Outcome) {
        self.face[i] = face_code(outcome);
        self.ended[i] = end_code(outcome);
        self.impacts[i] = outcome.impacts;
    }
}

impl<'a> Ends<'a> {
    /// The columns; `None` if they are not equally long.
    pub(crate) fn new(time_s: &'a mut [f64], last: &'a mut [f64]) -> Option<Self> {
        (last.len() == time_s.len() * ROW).then_some(Self { time_s, last })
    }

    fn split(self, n: usize) -> (Self, Self) {
        let (time_s, later_time_s) = self.time_s.split_at_mut(n);
        let (last, later_last) = self.last.split_at_mut(n * ROW);
        let later = Self {
            time_s: later_time_s,
            last: later_last,
        };
        (Self { time_s, last }, later)
    }

    /// Writes a toss on a table with this tilt to index `i`.
    pub(crate) fn write(
        &mut self,
        i: usize,
        toss: &FinishedToss,
        start: Start<'_>,
        tilt: Option<TableTilt>,
    ) {
        self.time_s[i] = toss.end.time_s;
        let mut end = tilt.map_or(toss.end, |tilt| tilt.state_in_laboratory(&toss.end));
        start.apply(&mut end);
        write_state(&end, &mut self.last[i * ROW..(i + 1) * ROW]);
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

//! Tosses one by one: each worker fills its own stretch of the columns.

use crate::columns::{Columns, Rest, Rows, face_code};
use crate::errors;
use crate::launch::{Fault, ROW, check, launch, write_launch};
use crate::plan::Plan;
use crate::share::{Stretch, share_out};
use crate::supervise::{Desk, supervise, threads};
use coinmc::engines::EngineError;
use coinmc::plan::{MAX_TOSSES, Point};
use coinmc::run::{Begin, for_each_end, for_each_outcome, stream};
use coinmc_core::Stream;
use numpy::{PyReadonlyArray2, PyReadwriteArray1, PyReadwriteArray2};
use pyo3::prelude::*;
use std::io;
use std::num::NonZeroUsize;
use std::ops::Range;

/// How the tosses begin: the number of the first and the stream of all, or rows of launches.
enum Source<'a> {
    Drawn(u64, Stream),
    Given(&'a [f64]),
}

/// Why tosses stopped.
enum Trouble {
    Settings(EngineError),
    Launch,
    Thread(io::Error),
}

impl From<io::Error> for Trouble {
    fn from(error: io::Error) -> Self {
        Self::Thread(error)
    }
}

/// Tosses of one point.
struct Job<'a> {
    point: &'a Point,
    source: Source<'a>,
}

impl Job<'_> {
    /// Makes the tosses of a stretch that begins at place `at`.
    fn fill(&self, at: usize, columns: Columns<'_>, desk: &Desk) -> Result<(), Trouble> {
        let n = columns.places();
        match &self.source {
            Source::Drawn(first, stream) => {
                let first = first + at as u64;
                let tosses = first..first + n as u64;
                self.follow(Begin::Drawn(stream), tosses, columns, |_| [0.0; 2], desk)
            }
            Source::Given(rows) => {
                let rows = &rows[at * ROW..(at + n) * ROW];
                if rows
                    .chunks_exact(ROW)
                    .any(|row| check(self.point, row).is_err())
                {
                    return Err(Trouble::Launch);
                }
                let row = |toss: u64| &rows[place(toss) * ROW..][..ROW];
                let begin = |toss| launch(row(toss));
                let from = |toss| [row(toss)[0], row(toss)[1]];
                self.follow(Begin::Given(&begin), 0..n as u64, columns, from, desk)
            }
        }
    }

    fn follow(
        &self,
        begin: Begin<'_>,
        tosses: Range<u64>,
        columns: Columns<'_>,
        from: impl Fn(u64) -> [f64; 2],
        desk: &Desk,
    ) -> Result<(), Trouble> {
        let (face, first) = (columns.face, tosses.start);
        let followed = match columns.rest {
            None => for_each_outcome(self.point, begin, tosses, |toss, outcome| {
                face[place(toss - first)] = face_code(outcome);
                desk.go_on()
            }),
            Some(mut rest) => for_each_end(self.point, begin, tosses, &mut |seen| {
                let i = place(seen.toss - first);
                face[i] = face_code(&seen.outcome);
                rest.write(i, seen, from(seen.toss));
                desk.go_on()
            }),
        };
        followed.map(drop).map_err(Trouble::Settings)
    }

    /// The exception of what stopped it. Workers may have met several bad launches: the first is
    /// told.
    fn raised(&self, trouble: Trouble) -> PyErr {
        match trouble {
            Trouble::Settings(error) => errors::value(error),
            Trouble::Thread(error) => errors::value(format!("cannot start a thread: {error}")),
            Trouble::Launch => errors::value(self.first_fault()),
        }
    }

    fn first_fault(&self) -> String {
        let Source::Given(rows) = self.source else {
            return String::new();
        };
        let faulty = |(number, row): (usize, &[f64])| -> Option<(usize, Fault)> {
            check(self.point, row).err().map(|fault| (number, fault))
        };
        let found = rows.chunks_exact(ROW).enumerate().find_map(faulty);
        found.map_or_else(String::new, |(number, fault)| {
            format!("launch {number}: {fault}")
        })
    }
}

/// A place in an array that there is.
fn place(index: u64) -> usize {
    usize::try_from(index).expect("an index of an array in memory")
}

/// Checks that toss numbers stay within what a plan may have.
fn must_fit(first: u64, n: usize) -> PyResult<()> {
    match first.checked_add(n as u64) {
        Some(end) if end <= MAX_TOSSES => Ok(()),
        _ => Err(errors::value(format!(
            "tosses are numbered below {MAX_TOSSES}"
        ))),
    }
}

/// What the tosses of a call are.
struct Call<'a> {
    plan: &'a Plan,
    point: usize,
    first: u64,
    rows: Option<&'a [f64]>,
    threads: Option<NonZeroUsize>,
    progress: Option<Py<PyAny>>,
}

impl Call<'_> {
    fn fill(self, py: Python<'_>, columns: Columns<'_>) -> PyResult<()> {
        let n = columns.places();
        must_fit(self.first, n)?;
        let source = match self.rows {
            Some(rows) if rows.len() != n * ROW => {
                return Err(errors::value("there must be as many launches as tosses"));
            }
            Some(rows) => Source::Given(rows),
            None => Source::Drawn(self.first, stream(&self.plan.0, self.point)),
        };
        let job = Job {
            point: self.plan.tossing(self.point)?,
            source,
        };
        let workers = workers(self.threads, n);
        let (done, _) = supervise(py, self.progress, |desk| {
            share_out(columns, workers, desk, |at, columns| {
                job.fill(at, columns, desk)
            })
        })?;
        done.map_err(|trouble| job.raised(trouble))
    }
}

/// Threads for so many tosses: no more than tosses.
fn workers(asked: Option<NonZeroUsize>, n: usize) -> usize {
    threads(asked).get().min(n.max(1))
}

/// The columns beside the face, as Python gives them: ended, impacts, time, and twelve numbers a toss.
type Beside<'py> = (
    PyReadwriteArray1<'py, u8>,
    PyReadwriteArray1<'py, u32>,
    PyReadwriteArray1<'py, f64>,
    PyReadwriteArray2<'py, f64>,
);

/// Fills `face`, and the columns beside it if they are given, with `len(face)` tosses: from number
/// `first`, or of the launches in `rows`.
#[pyfunction]
#[pyo3(signature = (plan, point, first, rows, face, beside=None, threads=None, progress=None))]
#[allow(clippy::too_many_arguments)] // Python's arguments
pub(crate) fn toss(
    py: Python<'_>,
    plan: &Plan,
    point: usize,
    first: u64,
    rows: Option<PyReadonlyArray2<'_, f64>>,
    mut face: PyReadwriteArray1<'_, u8>,
    mut beside: Option<Beside<'_>>,
    threads: Option<NonZeroUsize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<()> {
    let face = face.as_slice_mut()?;
    let rest = beside.as_mut().map(slices).transpose()?;
    if rest.as_ref().is_some_and(|rest| !rest.is_of(face.len())) {
        return Err(errors::value("columns must be equally long"));
    }
    let rows = rows.as_ref().map(PyReadonlyArray2::as_slice).transpose()?;
    let call = Call {
        plan,
        point,
        first,
        rows,
        threads,
        progress,
    };
    call.fill(py, Columns { face, rest })
}

fn slices<'a>((ended, impacts, time_s, last): &'a mut Beside<'_>) -> PyResult<Rest<'a>> {
    Ok(Rest {
        ended: ended.as_slice_mut()?,
        impacts: impacts.as_slice_mut()?,
        time_s: time_s.as_slice_mut()?,
        last: last.as_slice_mut()?,
    })
}

/// Fills rows with the launches of a point from number `first`.
#[pyfunction]
pub(crate) fn launches(
    py: Python<'_>,
    plan: &Plan,
    point: usize,
    first: u64,
    mut rows: PyReadwriteArray2<'_, f64>,
) -> PyResult<()> {
    let rows = rows.as_slice_mut()?;
    if !rows.len().is_multiple_of(ROW) {
        return Err(errors::value("a launch is a row of twelve numbers"));
    }
    let rows = Rows(rows);
    must_fit(first, rows.places())?;
    let (found, stream) = (plan.tossing(point)?, stream(&plan.0, point));
    let begin = Begin::Drawn(&stream);
    let draw = |at: usize, rows: Rows<'_>| -> Result<(), io::Error> {
        for (toss, row) in (first + at as u64..).zip(rows.0.chunks_exact_mut(ROW)) {
            write_launch(&begin.launch(found, toss), row);
        }
        Ok(())
    };
    let workers = workers(None, rows.places());
    let (drawn, _) = supervise(py, None, |desk| share_out(rows, workers, desk, draw))?;
    drawn.map_err(|error| errors::value(format!("cannot start a thread: {error}")))
}

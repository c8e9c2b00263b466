//! Individual tosses: each worker fills its own part of the columns.

use crate::columns::{Columns, Ends, Outcomes, Rows, face_code};
use crate::errors;
use crate::launch::{Fault, ROW, Start, check, launch, write_launch};
use crate::plan::Plan;
use crate::share::{Splittable, fill_in_parallel};
use crate::supervise::{Supervision, supervise, threads};
use coinmc::engines::EngineError;
use coinmc::plan::{MAX_TOSSES, Point};
use coinmc::run::{TossSource, for_each_end, for_each_outcome, stream};
use coinmc_core::Stream;
use numpy::{PyReadonlyArray2, PyReadwriteArray1, PyReadwriteArray2};
use pyo3::prelude::*;
use std::io;
use std::num::NonZeroUsize;
use std::ops::Range;

/// Launches of the tosses: drawn (index of the first toss, stream of all), or rows of given
/// launches.
enum Source<'a> {
    Drawn(u64, Stream),
    Given(&'a [f64]),
}

/// Why the tosses stopped.
enum TossError {
    Settings(EngineError),
    Launch,
    Thread(io::Error),
}

impl From<io::Error> for TossError {
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
    /// Computes the tosses of the columns that start at index `at`.
    fn fill(
        &self,
        at: usize,
        columns: Columns<'_>,
        supervision: &Supervision,
    ) -> Result<(), TossError> {
        let n = columns.len();
        match &self.source {
            Source::Drawn(first, stream) => {
                let first = first + at as u64;
                let tosses = first..first + n as u64;
                self.toss_into(
                    TossSource::Drawn(stream),
                    tosses,
                    columns,
                    |_| Start::MIDDLE,
                    supervision,
                )
            }
            Source::Given(rows) => {
                let rows = &rows[at * ROW..(at + n) * ROW];
                if rows
                    .chunks_exact(ROW)
                    .any(|row| check(self.point, row).is_err())
                {
                    return Err(TossError::Launch);
                }
                let row = |toss: u64| &rows[index(toss) * ROW..][..ROW];
                let source = |toss| launch(row(toss));
                let start = |toss| Start::of(row(toss));
                self.toss_into(
                    TossSource::Given(&source),
                    0..n as u64,
                    columns,
                    start,
                    supervision,
                )
            }
        }
    }

    fn toss_into<'b>(
        &self,
        source: TossSource<'_>,
        tosses: Range<u64>,
        columns: Columns<'_>,
        start: impl Fn(u64) -> Start<'b>,
        supervision: &Supervision,
    ) -> Result<(), TossError> {
        let (first, tilt) = (tosses.start, self.point.scene.surface.tilt());
        let tossed = match columns {
            Columns::Faces(face) => {
                for_each_outcome(self.point, source, tosses, |toss, outcome| {
                    face[index(toss - first)] = face_code(outcome);
                    supervision.may_continue()
                })
            }
            Columns::Outcomes(mut outcomes) => {
                for_each_outcome(self.point, source, tosses, |toss, outcome| {
                    outcomes.write(index(toss - first), outcome);
                    supervision.may_continue()
                })
            }
            Columns::Ends(mut ends) => for_each_end(self.point, source, tosses, &mut |finished| {
                let i = index(finished.toss - first);
                ends.write(i, finished, start(finished.toss), tilt);
                supervision.may_continue()
            }),
        };
        tossed.map(drop).map_err(TossError::Settings)
    }

    /// The exception for an error. Of several invalid launches the first is reported.
    fn exception(&self, error: TossError) -> PyErr {
        match error {
            TossError::Settings(error) => errors::value(error),
            TossError::Thread(error) => errors::value(format!("cannot start a thread: {error}")),
            TossError::Launch => errors::value(self.first_fault()),
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

/// An index of an existing element.
fn index(index: u64) -> usize {
    usize::try_from(index).expect("an index of an array in memory")
}

/// Checks that the indices of the tosses do not exceed those of a plan.
fn must_fit(first: u64, n: usize) -> PyResult<()> {
    match first.checked_add(n as u64) {
        Some(end) if end <= MAX_TOSSES => Ok(()),
        _ => Err(errors::value(format!(
            "tosses must be numbered below {MAX_TOSSES}"
        ))),
    }
}

/// The arguments of a call.
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
        let n = columns.len();
        must_fit(self.first, n)?;
        let source = match self.rows {
            Some(rows) if rows.len() != n * ROW => {
                return Err(errors::value("there must be as many launches as tosses"));
            }
            Some(rows) => Source::Given(rows),
            None => Source::Drawn(self.first, stream(&self.plan.0, self.point)),
        };
        let job = Job {
            point: self.plan.tossed_point(self.point)?,
            source,
        };
        let workers = workers(self.threads, n);
        let (done, _) = supervise(py, self.progress, |supervision| {
            fill_in_parallel(columns, workers, supervision, |at, columns| {
                job.fill(at, columns, supervision)
            })
        })?;
        done.map_err(|error| job.exception(error))
    }
}

/// Number of threads for `n` tosses, at most one per toss.
fn workers(asked: Option<NonZeroUsize>, n: usize) -> usize {
    threads(asked).get().min(n.max(1))
}

/// The columns to fill, as Python arrays of one element per toss (of `last`, twelve): the face, why
/// it ended and its impacts, or the time and the state at the end.
#[derive(FromPyObject)]
pub(crate) enum Arrays<'py> {
    Outcomes(
        PyReadwriteArray1<'py, u8>,
        PyReadwriteArray1<'py, u8>,
        PyReadwriteArray1<'py, u32>,
    ),
    Ends(PyReadwriteArray1<'py, f64>, PyReadwriteArray2<'py, f64>),
    Faces(PyReadwriteArray1<'py, u8>),
}

impl Arrays<'_> {
    fn columns(&mut self) -> PyResult<Columns<'_>> {
        let columns = match self {
            Self::Faces(face) => Some(Columns::Faces(face.as_slice_mut()?)),
            Self::Outcomes(face, ended, impacts) => Outcomes::new(
                face.as_slice_mut()?,
                ended.as_slice_mut()?,
                impacts.as_slice_mut()?,
            )
            .map(Columns::Outcomes),
            Self::Ends(time_s, last) => {
                Ends::new(time_s.as_slice_mut()?, last.as_slice_mut()?).map(Columns::Ends)
            }
        };
        columns.ok_or_else(|| errors::value("columns must be equally long"))
    }
}

/// Fills columns with as many tosses: from index `first`, or of the launches in `rows`.
#[pyfunction]
#[pyo3(signature = (plan, point, first, rows, columns, threads=None, progress=None))]
#[allow(clippy::too_many_arguments)] // Python's arguments
pub(crate) fn toss(
    py: Python<'_>,
    plan: &Plan,
    point: usize,
    first: u64,
    rows: Option<PyReadonlyArray2<'_, f64>>,
    mut columns: Arrays<'_>,
    threads: Option<NonZeroUsize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<()> {
    let rows = rows.as_ref().map(PyReadonlyArray2::as_slice).transpose()?;
    let call = Call {
        plan,
        point,
        first,
        rows,
        threads,
        progress,
    };
    call.fill(py, columns.columns()?)
}

/// Fills rows with the launches of a point from toss `first`.
#[pyfunction]
#[pyo3(signature = (plan, point, first, rows, threads=None))]
pub(crate) fn launches(
    py: Python<'_>,
    plan: &Plan,
    point: usize,
    first: u64,
    mut rows: PyReadwriteArray2<'_, f64>,
    threads: Option<NonZeroUsize>,
) -> PyResult<()> {
    let rows = rows.as_slice_mut()?;
    if !rows.len().is_multiple_of(ROW) {
        return Err(errors::value("a launch is a row of twelve numbers"));
    }
    let rows = Rows(rows);
    must_fit(first, rows.len())?;
    let (found, stream) = (plan.tossed_point(point)?, stream(&plan.0, point));
    let source = TossSource::Drawn(&stream);
    let draw = |at: usize, rows: Rows<'_>| -> Result<(), io::Error> {
        for (toss, row) in (first + at as u64..).zip(rows.0.chunks_exact_mut(ROW)) {
            write_launch(&source.launch(found, toss), row);
        }
        Ok(())
    };
    let workers = workers(threads, rows.len());
    let (drawn, _) = supervise(py, None, |supervision| {
        fill_in_parallel(rows, workers, supervision, draw)
    })?;
    drawn.map_err(|error| errors::value(format!("cannot start a thread: {error}")))
}

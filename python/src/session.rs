//! Runs whose chunks are computed by other processes.

use crate::errors;
use crate::plan::Plan;
use crate::results::Results;
use crate::supervise::{Supervision, supervise};
use coinmc::run::{
    self, Chunk, Delivery, RunError, Session as Steered, Step, numbered_chunk, text_of_tally,
};
use coinmc_core::Tally;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Point, first toss, and the one after the last.
type Place = (usize, u64, u64);

/// A run in a run directory, or in memory, that hands out chunks and takes their results.
#[pyclass(frozen, module = "coinmc._lib")]
pub(crate) struct Session {
    run: Mutex<Option<Steered>>,
    warnings: Supervision,
}

#[pymethods]
impl Session {
    #[new]
    fn new(py: Python<'_>, plan: &Plan, out: Option<PathBuf>) -> PyResult<Self> {
        let warnings = Supervision::default();
        let run = py.detach(|| match &out {
            Some(out) => Steered::open(&plan.0, out, coinmc_build::BUILD, &warnings),
            None => Ok(Steered::in_memory(&plan.0)),
        });
        let run = run.map_err(|error| errors::run(&error))?;
        Ok(Self {
            run: Mutex::new(Some(run)),
            warnings,
        })
    }

    /// At most so many chunks that can be computed now, and whether the run is complete.
    fn take(&self, py: Python<'_>, most: usize) -> PyResult<(Vec<Place>, bool)> {
        self.with(py, |run| {
            let mut chunks = Vec::new();
            while chunks.len() < most {
                match run.next() {
                    Step::Chunk(Chunk { point, tosses }) => {
                        chunks.push((point, tosses.start, tosses.end));
                    }
                    Step::Wait => break,
                    Step::Done => return Ok((chunks, true)),
                }
            }
            Ok((chunks, false))
        })
    }

    /// Stores and counts results: texts, and notes of who made them, which may be empty.
    fn accept(&self, py: Python<'_>, results: Vec<(Vec<u8>, Vec<u8>)>) -> PyResult<()> {
        self.with(py, |run| {
            let deliveries = results.iter().map(|(text, note)| Delivery { text, note });
            let accepted = run.accept(deliveries);
            accepted.map_err(|error| errors::run(&error))
        })
    }

    /// Tosses done and planned.
    fn progress(&self, py: Python<'_>) -> PyResult<(u64, u64)> {
        self.with(py, |run| {
            let progress = run.progress();
            Ok((progress.tosses_done, progress.tosses_planned))
        })
    }

    /// Ends the run, or interrupts it, and releases its directory: the results and the warnings.
    fn conclude(&self, py: Python<'_>) -> PyResult<(Results, Vec<String>)> {
        let run = py.detach(|| self.lock().take()).ok_or_else(ended)?;
        let report = py.detach(|| run.conclude(&self.warnings));
        let report = report.map_err(|error| errors::run(&error))?;
        Ok((Results::new(report)?, self.warnings.take_warnings()))
    }
}

impl Session {
    fn lock(&self) -> MutexGuard<'_, Option<Steered>> {
        self.run.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Other threads of Python run meanwhile: another one may wait for the disk while it holds the run.
    fn with<T: Send>(
        &self,
        py: Python<'_>,
        act: impl FnOnce(&mut Steered) -> PyResult<T> + Send,
    ) -> PyResult<T> {
        py.detach(|| act(self.lock().as_mut().ok_or_else(ended)?))
    }
}

fn ended() -> PyErr {
    errors::value("this run has ended")
}

/// Computes a chunk on so many threads: the text of its tally.
#[pyfunction]
pub(crate) fn chunk<'py>(
    py: Python<'py>,
    plan: &Plan,
    point: usize,
    start: u64,
    end: u64,
    threads: NonZeroUsize,
) -> PyResult<Bound<'py, PyBytes>> {
    let place = (point, start, end);
    let text = computed(py, plan, place, |plan, chunk, go_on| {
        run::chunk_text(plan, chunk, threads, go_on)
    })?;
    Ok(PyBytes::new(py, text.as_bytes()))
}

/// The same, and a note of who computed it and how long it took.
#[pyfunction]
pub(crate) fn chunk_with_note<'py>(
    py: Python<'py>,
    plan: &Plan,
    point: usize,
    start: u64,
    end: u64,
    threads: NonZeroUsize,
) -> PyResult<(Bound<'py, PyBytes>, Bound<'py, PyBytes>)> {
    let place = (point, start, end);
    let (text, note) = computed(py, plan, place, |plan, chunk, go_on| {
        run::chunk_with_note(plan, chunk, coinmc_build::BUILD, threads, go_on)
    })?;
    let bytes = |text: &str| PyBytes::new(py, text.as_bytes());
    Ok((bytes(&text), bytes(&note)))
}

/// What a chunk is computed to, under supervision.
fn computed<T: Default + Send>(
    py: Python<'_>,
    plan: &Plan,
    (point, start, end): Place,
    compute: impl FnOnce(
        &coinmc::plan::Plan,
        &Chunk,
        &(dyn Fn() -> bool + Sync),
    ) -> Result<Option<T>, RunError>
    + Send,
) -> PyResult<T> {
    let chunk = Chunk {
        point,
        tosses: start..end,
    };
    let (done, _) = supervise(py, None, |supervision| {
        compute(&plan.0, &chunk, &|| supervision.may_continue())
    })?;
    // stopped only by a signal, which has been raised
    Ok(done
        .map_err(|error| errors::run(&error))?
        .unwrap_or_default())
}

/// The chunk of this number where the number of tosses is fixed.
#[pyfunction]
pub(crate) fn chunk_of_number(plan: &Plan, number: u64) -> Option<Place> {
    let Chunk { point, tosses } = numbered_chunk(&plan.0, number)?;
    Some((point, tosses.start, tosses.end))
}

/// The text of a chunk's tally as if its tosses had shown heads, tails and side so often: for simulations of
/// runs.
#[pyfunction]
pub(crate) fn tally_of<'py>(
    py: Python<'py>,
    plan: &Plan,
    place: Place,
    heads: u64,
    tails: u64,
) -> Bound<'py, PyBytes> {
    let (point, start, end) = place;
    let chunk = Chunk {
        point,
        tosses: start..end,
    };
    let side = (end - start).saturating_sub(heads).saturating_sub(tails);
    let tally = Tally {
        heads,
        tails,
        side,
        ..Tally::default()
    };
    PyBytes::new(py, text_of_tally(&plan.0, &chunk, &tally).as_bytes())
}

//! Estimates in memory, runs in a directory, and reading such directories.

use crate::errors;
use crate::plan::Plan;
use crate::results::Results;
use crate::supervise::supervise;
use coinmc::run::{Count, Options, Part, count, run as run_plan, stored_report};
use pyo3::prelude::*;
use std::num::NonZeroUsize;
use std::path::PathBuf;

/// A value and the warnings.
type WithWarnings<T> = PyResult<(T, Vec<String>)>;

/// Counts all points in memory.
#[pyfunction]
#[pyo3(signature = (plan, threads=None, progress=None))]
pub(crate) fn estimate(
    py: Python<'_>,
    plan: &Plan,
    threads: Option<NonZeroUsize>,
    progress: Option<Py<PyAny>>,
) -> WithWarnings<Results> {
    let (report, warnings) = supervise(py, progress, |supervision| {
        let options = Count {
            threads,
            cancel: &supervision.stop,
            sink: supervision,
        };
        count(&plan.0, &options)
    })?;
    let report = report.map_err(|error| errors::run(&error))?;
    Ok((Results::new(report)?, warnings))
}

/// Runs a plan, or resumes it, in a run directory.
#[pyfunction]
#[pyo3(signature = (plan, out, threads=None, progress=None))]
pub(crate) fn run(
    py: Python<'_>,
    plan: &Plan,
    out: PathBuf,
    threads: Option<NonZeroUsize>,
    progress: Option<Py<PyAny>>,
) -> WithWarnings<Results> {
    let (report, warnings) = supervise(py, progress, |supervision| {
        let options = Options {
            out: &out,
            build: coinmc_build::BUILD,
            part: Part::WHOLE,
            threads,
            cancel: &supervision.stop,
            sink: supervision,
        };
        run_plan(&plan.0, &options)
    })?;
    let report = report.map_err(|error| errors::run(&error))?;
    Ok((Results::new(report)?, warnings))
}

/// Reads a run directory, finished or not.
#[pyfunction]
pub(crate) fn open(py: Python<'_>, path: PathBuf) -> WithWarnings<(Plan, Results)> {
    let (read, warnings) = supervise(py, None, |supervision| stored_report(&path, supervision))?;
    let (plan, report) = read.map_err(|error| errors::run(&error))?;
    Ok(((Plan::from(plan), Results::new(report)?), warnings))
}

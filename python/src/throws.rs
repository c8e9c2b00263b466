//! The throws of a robot's journal for Python.

use crate::{arrow, errors};
use arrow_array::RecordBatch;
use coinmc_robot::Directory;
use coinmc_robot::export::{rows, throws_batch};
use pyo3::prelude::*;
use pyo3::types::{PyCapsule, PyDict};
use std::path::PathBuf;

/// All resolved throws of an experiment.
#[pyclass(frozen, module = "coinmc._lib")]
pub(crate) struct Throws {
    batch: RecordBatch,
    config: String,
    planned: u32,
    announced: u32,
}

#[pymethods]
impl Throws {
    /// Reads the journal in the directory of an experiment.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        py.detach(|| {
            let (experiment, history) = Directory::at(&path).read().map_err(errors::journal)?;
            let rows = rows(&experiment, &history).map_err(errors::journal)?;
            Ok(Self {
                batch: throws_batch(&rows).map_err(errors::value)?,
                config: experiment.plan().resolved_toml.clone(),
                planned: experiment.throws(),
                announced: history.announced(),
            })
        })
    }

    /// The config of the experiment, as TOML.
    #[getter]
    fn config(&self) -> &str {
        &self.config
    }

    /// Throws planned.
    #[getter]
    fn planned(&self) -> u32 {
        self.planned
    }

    /// Throws announced so far; the last may not be resolved yet.
    #[getter]
    fn announced(&self) -> u32 {
        self.announced
    }

    /// Name, unit and meaning of every column.
    fn describe(&self) -> Vec<(String, String, String)> {
        arrow::describe(&self.batch)
    }

    /// The columns: arrays of numbers, lists of strings.
    fn columns<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        arrow::columns(py, &self.batch)
    }

    /// The stream of the Arrow PyCapsule interface.
    #[pyo3(signature = (requested_schema=None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        let _ = requested_schema;
        arrow::stream(py, &self.batch)
    }
}

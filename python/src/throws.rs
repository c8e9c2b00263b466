//! The throws of a robot's journal for Python.

use crate::{arrow, errors};
use arrow_array::{ArrayRef, Float64Array, RecordBatch};
use arrow_schema::{DataType, Field, Schema};
use coinmc_robot::Directory;
use coinmc_robot::export::{rows, throws_cell, throws_fields};
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyCapsule, PyDict};
use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

/// All resolved throws of an experiment.
#[pyclass(frozen, module = "coinmc._lib")]
pub(crate) struct Throws {
    batch: RecordBatch,
    config: String,
    planned: u32,
    announced: u32,
}

/// A column of numbers from Python: name, unit, meaning and values; NaN is missing.
type Numbers<'py> = (String, String, String, PyReadonlyArray1<'py, f64>);

#[pymethods]
impl Throws {
    /// Reads the journal in the directory of an experiment.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        py.detach(|| {
            let (experiment, history) = Directory::at(&path).read().map_err(errors::journal)?;
            let rows = rows(&experiment, &history).map_err(errors::journal)?;
            Ok(Self {
                batch: arrow::batch(&throws_fields(), HashMap::new(), &rows.iter(), throws_cell)?,
                config: experiment.plan().resolved_toml.clone(),
                planned: experiment.throws(),
                announced: history.announced(),
            })
        })
    }

    /// The same throws with more columns.
    fn with_numbers(&self, more: Vec<Numbers<'_>>) -> PyResult<Self> {
        let schema = self.batch.schema();
        let mut fields: Vec<_> = schema.fields().iter().cloned().collect();
        let mut columns = self.batch.columns().to_vec();
        for (name, unit, meaning, values) in more {
            let about = [("unit", unit), ("description", meaning)];
            let about: HashMap<_, _> = about.map(|(key, text)| (key.to_owned(), text)).into();
            let field = Field::new(name, DataType::Float64, true).with_metadata(about);
            let values = values.as_slice()?.iter();
            let values = values.map(|value| Some(*value).filter(|value| !value.is_nan()));
            fields.push(Arc::new(field));
            columns.push(Arc::new(values.collect::<Float64Array>()) as ArrayRef);
        }
        let batch = RecordBatch::try_new(Arc::new(Schema::new(fields)), columns);
        Ok(Self {
            batch: batch.map_err(errors::value)?,
            config: self.config.clone(),
            planned: self.planned,
            announced: self.announced,
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

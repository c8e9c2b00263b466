//! The table of results for Python: as NumPy arrays, and as Arrow without copying.

use crate::pickled::{Plain, plain};
use crate::{arrow, errors};
use arrow_array::RecordBatch;
use coinmc::results::{Column, FairRatio, Results as Table, columns_of, fair_values, metadata};
use coinmc::run::{Report, Status};
use coinmc_core::Face;
use pyo3::prelude::*;
use pyo3::types::{PyCapsule, PyDict};

/// The results of a run or an estimate.
#[pyclass(frozen, module = "coinmc._lib")]
pub(crate) struct Results {
    table: Table,
    batch: RecordBatch,
    pub(crate) status: Status,
    pub(crate) tosses: u64,
}

/// A crossing: the other parameters, engine, law, value, its interval, confidence, rising.
type Crossing = (
    Vec<(String, f64)>,
    &'static str,
    &'static str,
    f64,
    Option<f64>,
    Option<f64>,
    f64,
    bool,
);

impl Results {
    /// The results of a report.
    pub(crate) fn new(report: Report) -> PyResult<Self> {
        let batch = record_batch(&report.results)?;
        Ok(Self {
            table: report.results,
            batch,
            status: report.status,
            tosses: report.tosses,
        })
    }

    pub(crate) fn table(&self) -> &Table {
        &self.table
    }

    /// The report that it was made of, as far as pages need it.
    pub(crate) fn report(&self) -> Report {
        Report {
            results: self.table.clone(),
            status: self.status,
            reused_chunks: 0,
            tosses: self.tosses,
            tosses_planned: self.tosses,
        }
    }

    pub(crate) fn status_name(&self) -> &'static str {
        match self.status {
            Status::Complete => "complete",
            Status::Interrupted => "interrupted",
            Status::Part => "part",
            Status::ShortOfTarget { .. } => "short",
        }
    }
}

/// The table as Arrow has it.
fn record_batch(table: &Table) -> PyResult<RecordBatch> {
    let columns = columns_of(table);
    let fields: Vec<_> = columns.iter().map(Column::field).collect();
    let metadata = metadata(table).map(|(key, text)| (key.to_owned(), text));
    let cell = |row, column: usize| columns[column].cell(row);
    arrow::batch(&fields, metadata.into(), &table.rows.iter(), cell)
}

#[pymethods]
impl Results {
    fn __len__(&self) -> usize {
        self.table.rows.len()
    }

    #[getter]
    fn tosses(&self) -> u64 {
        self.tosses
    }

    /// `complete`, `interrupted`, `part` or `short`.
    #[getter]
    fn status(&self) -> &'static str {
        self.status_name()
    }

    /// Plain values, from which [`unpickled`](crate::pickled::unpickled) makes the results again.
    fn plain(&self) -> Plain {
        plain(self)
    }

    #[getter]
    fn axes(&self) -> Vec<String> {
        self.table.axes.clone()
    }

    #[getter]
    fn config(&self) -> &str {
        &self.table.config
    }

    /// Metadata of the table.
    #[getter]
    fn metadata<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let entries = PyDict::new(py);
        let schema = self.batch.schema();
        let mut sorted: Vec<_> = schema.metadata().iter().collect();
        sorted.sort();
        for (key, value) in sorted {
            entries.set_item(key.strip_prefix("coinmc.").unwrap_or(key), value)?;
        }
        Ok(entries)
    }

    /// Name, unit and meaning of every column.
    fn describe(&self) -> Vec<(String, String, String)> {
        arrow::describe(&self.batch)
    }

    /// The columns: arrays of numbers and booleans, lists of strings.
    fn columns<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        arrow::columns(py, &self.batch)
    }

    /// The stream of the Arrow PyCapsule interface. A requested schema is ignored, as the interface
    /// permits.
    #[pyo3(signature = (requested_schema=None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        let _ = requested_schema;
        arrow::stream(py, &self.batch)
    }

    /// Where the probability of a face crosses a target along a swept parameter.
    fn fair(&self, target: f64, face: &str, along: &str) -> PyResult<Vec<Crossing>> {
        let face = Face::ALL.into_iter().find(|known| known.name() == face);
        let face = face.ok_or_else(|| errors::value("the faces are heads, tails and side"))?;
        let found = fair_values(&self.table, face, along, target);
        Ok(found.into_iter().map(crossing).collect())
    }
}

fn crossing(fair: FairRatio) -> Crossing {
    (
        fair.at,
        fair.engine,
        fair.law,
        fair.ratio,
        fair.lo,
        fair.hi,
        fair.confidence,
        fair.rising,
    )
}

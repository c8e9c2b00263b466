//! Arrow tables for Python: as NumPy arrays, and as a stream without copying.

use crate::errors;
use arrow_array::cast::AsArray;
use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::types::{Float64Type, UInt64Type};
use arrow_array::{
    Array, ArrayRef, BooleanArray, Float32Array, Float64Array, RecordBatch, RecordBatchIterator,
    StringArray, UInt64Array,
};
use arrow_schema::{DataType, Field, Schema};
use coinmc_table::{Cell, Kind};
use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::{PyCapsule, PyDict};
use std::collections::HashMap;
use std::sync::Arc;

/// Name of stream capsules in the Arrow PyCapsule interface.
const STREAM: &std::ffi::CStr = c"arrow_array_stream";

/// A table as Arrow has it, with this metadata. `cell` is the cell of a row in the column with this index.
pub(crate) fn batch<'c, R>(
    fields: &[coinmc_table::Field],
    metadata: HashMap<String, String>,
    rows: &(impl Iterator<Item = R> + Clone),
    cell: impl Fn(R, usize) -> Cell<'c>,
) -> PyResult<RecordBatch> {
    let columns = fields.iter().enumerate();
    let arrays = columns.map(|(index, field)| {
        let cells = rows.clone().map(|row| cell(row, index));
        array(field.kind, cells)
    });
    let arrays = arrays.collect();
    let fields: Vec<Field> = fields.iter().map(field).collect();
    let schema = Schema::new_with_metadata(fields, metadata);
    RecordBatch::try_new(Arc::new(schema), arrays).map_err(errors::value)
}

fn field(field: &coinmc_table::Field) -> Field {
    let data_type = match field.kind {
        Kind::Count => DataType::UInt64,
        Kind::Number => DataType::Float64,
        Kind::Single => DataType::Float32,
        Kind::Text => DataType::Utf8,
        Kind::Flag => DataType::Boolean,
    };
    let metadata = field.metadata();
    let metadata = metadata.map(|(key, text)| (key.to_owned(), text.to_owned()));
    Field::new(&field.name, data_type, field.optional).with_metadata(metadata.collect())
}

/// The cells of a column; a cell of another kind is missing.
fn array<'c>(kind: Kind, cells: impl Iterator<Item = Cell<'c>>) -> ArrayRef {
    match kind {
        Kind::Count => Arc::new(cells.map(Cell::count).collect::<UInt64Array>()),
        Kind::Number => Arc::new(cells.map(Cell::number).collect::<Float64Array>()),
        Kind::Single => Arc::new(cells.map(Cell::single).collect::<Float32Array>()),
        Kind::Text => Arc::new(cells.map(Cell::text).collect::<StringArray>()),
        Kind::Flag => Arc::new(cells.map(Cell::flag).collect::<BooleanArray>()),
    }
}

/// Name, unit and meaning of every column.
pub(crate) fn describe(batch: &RecordBatch) -> Vec<(String, String, String)> {
    let about = |field: &Field, key: &str| field.metadata().get(key).cloned().unwrap_or_default();
    let schema = batch.schema();
    let fields = schema.fields().iter();
    fields
        .map(|field| {
            let name = field.name().clone();
            (name, about(field, "unit"), about(field, "description"))
        })
        .collect()
}

/// The columns: arrays of numbers and booleans, lists of strings.
pub(crate) fn columns<'py>(py: Python<'py>, batch: &RecordBatch) -> PyResult<Bound<'py, PyDict>> {
    let columns = PyDict::new(py);
    let schema = batch.schema();
    for (field, array) in schema.fields().iter().zip(batch.columns()) {
        columns.set_item(field.name(), numpy(py, array)?)?;
    }
    Ok(columns)
}

/// The stream of the Arrow PyCapsule interface. Arrays are shared, not copied.
pub(crate) fn stream<'py>(py: Python<'py>, batch: &RecordBatch) -> PyResult<Bound<'py, PyCapsule>> {
    let batches = RecordBatchIterator::new([Ok(batch.clone())], batch.schema());
    let stream = FFI_ArrowArrayStream::new(Box::new(batches));
    PyCapsule::new_with_value(py, stream, STREAM)
}

/// A column; missing numbers become NaN.
fn numpy<'py>(py: Python<'py>, array: &ArrayRef) -> PyResult<Bound<'py, PyAny>> {
    Ok(match array.data_type() {
        DataType::UInt64 if array.null_count() == 0 => {
            let values = array.as_primitive::<UInt64Type>().values().to_vec();
            values.into_pyarray(py).into_any()
        }
        #[allow(clippy::cast_precision_loss)] // counts and times are far below 2^53
        DataType::UInt64 => {
            let values = array.as_primitive::<UInt64Type>().iter();
            let values: Vec<f64> = values
                .map(|value| value.map_or(f64::NAN, |count| count as f64))
                .collect();
            values.into_pyarray(py).into_any()
        }
        DataType::Float64 => {
            let values = array.as_primitive::<Float64Type>().iter();
            let values: Vec<f64> = values.map(|value| value.unwrap_or(f64::NAN)).collect();
            values.into_pyarray(py).into_any()
        }
        DataType::Boolean => {
            let values = array.as_boolean().iter();
            let values: Vec<bool> = values.map(Option::unwrap_or_default).collect();
            values.into_pyarray(py).into_any()
        }
        _ => {
            let values = array.as_string::<i32>().iter();
            let values: Vec<&str> = values.map(Option::unwrap_or_default).collect();
            values.into_pyobject(py)?
        }
    })
}

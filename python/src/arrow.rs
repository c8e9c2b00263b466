//! Arrow tables for Python: as NumPy arrays, and as a stream without copying.

use arrow_array::cast::AsArray;
use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::types::{Float64Type, UInt64Type};
use arrow_array::{Array, ArrayRef, RecordBatch, RecordBatchIterator};
use arrow_schema::{DataType, Field};
use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::{PyCapsule, PyDict};

/// Name of stream capsules in the Arrow PyCapsule interface.
const STREAM: &std::ffi::CStr = c"arrow_array_stream";

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

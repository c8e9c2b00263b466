//! Columns of NumPy arrays as a table of Arrow.

use crate::arrow::stream;
use crate::errors;
use arrow_array::types::{Float64Type, Int64Type, UInt8Type, UInt32Type, UInt64Type};
use arrow_array::{ArrayRef, BooleanArray, PrimitiveArray, RecordBatch, StringArray};
use arrow_schema::{Field, Schema};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyCapsule;
use std::collections::HashMap;
use std::sync::Arc;

/// A column: name, unit, meaning, and an array of one dimension or a list of strings.
type Column<'py> = (String, String, String, Bound<'py, PyAny>);

/// The stream of the Arrow PyCapsule interface for these columns, which are copied.
#[pyfunction]
pub(crate) fn arrow_stream<'py>(
    py: Python<'py>,
    columns: Vec<Column<'py>>,
    metadata: HashMap<String, String>,
) -> PyResult<Bound<'py, PyCapsule>> {
    let mut fields = Vec::with_capacity(columns.len());
    let mut arrays = Vec::with_capacity(columns.len());
    for (name, unit, description, column) in columns {
        let array = array_of(&column)?;
        let about = [("unit", unit), ("description", description)];
        let about = about.map(|(key, text)| (key.to_owned(), text));
        let field = Field::new(name, array.data_type().clone(), false);
        fields.push(field.with_metadata(HashMap::from(about)));
        arrays.push(array);
    }
    let schema = Arc::new(Schema::new(fields).with_metadata(metadata));
    let batch = RecordBatch::try_new(schema, arrays).map_err(errors::value)?;
    stream(py, &batch)
}

fn array_of(column: &Bound<'_, PyAny>) -> PyResult<ArrayRef> {
    macro_rules! primitive {
        ($($number:ty => $arrow:ty),*) => {
            $(if let Ok(array) = column.cast::<PyArray1<$number>>() {
                let values = array.to_vec()?;
                return Ok(Arc::new(PrimitiveArray::<$arrow>::from(values)));
            })*
        };
    }
    primitive!(f64 => Float64Type, u64 => UInt64Type, i64 => Int64Type, u32 => UInt32Type,
               u8 => UInt8Type);
    if let Ok(array) = column.cast::<PyArray1<bool>>() {
        return Ok(Arc::new(BooleanArray::from(array.to_vec()?)));
    }
    let texts: Vec<String> = column.extract()?;
    Ok(Arc::new(StringArray::from(texts)))
}

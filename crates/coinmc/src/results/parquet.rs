//! The results table as Parquet, with units and the config in its metadata.

use super::schema::{Cell, Column, FORMAT, Kind, columns_of};
use super::{Results, Row};
use arrow_array::{ArrayRef, BooleanArray, Float64Array, RecordBatch, StringArray, UInt64Array};
use arrow_schema::{ArrowError, DataType, Field, Schema};
use parquet::arrow::ArrowWriter;
use parquet::basic::Compression;
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use std::collections::HashMap;
use std::io::{self, Write};
use std::sync::Arc;

/// Rows of a row group, which is the part held in memory.
const GROUP: usize = 1 << 14;

/// Writes the table. The same results give the same bytes: no time, host or path is in them.
///
/// # Errors
/// Those of `out`.
pub fn write_parquet(results: &Results, out: &mut (dyn Write + Send)) -> io::Result<()> {
    let mut table = ParquetTable::new(results, out)?;
    for row in results.rows.each() {
        table.push(row.into_owned())?;
    }
    table.finish()
}

/// The table, row by row.
pub(super) struct ParquetTable<'a> {
    writer: ArrowWriter<&'a mut (dyn Write + Send)>,
    schema: Arc<Schema>,
    columns: Vec<Column>,
    group: Vec<Row>,
}

impl<'a> ParquetTable<'a> {
    pub(super) fn new(results: &Results, out: &'a mut (dyn Write + Send)) -> io::Result<Self> {
        let columns = columns_of(results);
        // in the schema for those who read Arrow's, in the file for others
        let schema = Arc::new(schema(results, &columns));
        let properties = WriterProperties::builder()
            .set_created_by(format!("coinmc {}", results.program_version))
            .set_compression(Compression::SNAPPY)
            .set_key_value_metadata(Some(metadata(results)))
            .build();
        let writer = ArrowWriter::try_new(out, Arc::clone(&schema), Some(properties));
        Ok(Self {
            writer: writer.map_err(parquet_error)?,
            schema,
            columns,
            group: Vec::new(),
        })
    }

    pub(super) fn push(&mut self, row: Row) -> io::Result<()> {
        self.group.push(row);
        if self.group.len() == GROUP {
            self.write_group()?;
        }
        Ok(())
    }

    fn write_group(&mut self) -> io::Result<()> {
        let batch = batch(&self.schema, &self.columns, &self.group.iter());
        self.group.clear();
        self.writer
            .write(&batch.map_err(io::Error::other)?)
            .and_then(|()| self.writer.flush())
            .map_err(parquet_error)
    }

    pub(super) fn finish(mut self) -> io::Result<()> {
        if !self.group.is_empty() {
            self.write_group()?;
        }
        self.writer.close().map(drop).map_err(parquet_error)
    }
}

/// The table as an Arrow record batch: the columns of the Parquet file, with the file's metadata in the
/// schema.
///
/// # Errors
/// [`ArrowError`] if the table is beyond what Arrow can hold.
pub fn record_batch(results: &Results) -> Result<RecordBatch, ArrowError> {
    let columns = columns_of(results);
    let schema = schema(results, &columns);
    batch(&Arc::new(schema), &columns, &results.rows.iter())
}

/// The schema, with what the table says of itself.
fn schema(results: &Results, columns: &[Column]) -> Schema {
    let entries = metadata(results).into_iter();
    let entries = entries.filter_map(|entry| Some((entry.key, entry.value?)));
    let fields: Vec<_> = columns.iter().map(field).collect();
    Schema::new_with_metadata(fields, entries.collect::<HashMap<_, _>>())
}

fn batch<'a>(
    schema: &Arc<Schema>,
    columns: &[Column],
    rows: &(impl Iterator<Item = &'a Row> + Clone),
) -> Result<RecordBatch, ArrowError> {
    let array =
        |column: &Column| arrow_array(column.kind, rows.clone().map(|row| column.cell(row)));
    let arrays = columns.iter().map(array).collect();
    RecordBatch::try_new(Arc::clone(schema), arrays)
}

fn field(column: &Column) -> Field {
    arrow_field(&column.name, column.kind, column.unit, column.doc)
}

/// A field of a schema, with its unit and meaning as metadata.
pub fn arrow_field(name: &str, kind: Kind, unit: &str, doc: &str) -> Field {
    let data_type = match kind {
        Kind::Count => DataType::UInt64,
        Kind::Number => DataType::Float64,
        Kind::Text => DataType::Utf8,
        Kind::Flag => DataType::Boolean,
    };
    // only numbers can be missing
    let metadata = [("unit", unit), ("description", doc)];
    let metadata = metadata.into_iter().filter(|(_, text)| !text.is_empty());
    let metadata = metadata.map(|(key, text)| (key.to_owned(), text.to_owned()));
    Field::new(name, data_type, kind == Kind::Number)
        .with_metadata(metadata.collect::<HashMap<_, _>>())
}

fn metadata(results: &Results) -> Vec<KeyValue> {
    let entry = |key: &str, value: &str| KeyValue::new(format!("coinmc.{key}"), value.to_owned());
    vec![
        entry("format", &FORMAT.to_string()),
        entry("program_version", &results.program_version),
        entry("plan_hash", &results.plan_hash),
        entry("axes", &results.axes.join(",")),
        entry("config", &results.config),
    ]
}

/// The cells of a column; a cell of another kind is missing.
pub fn arrow_array<'a>(kind: Kind, cells: impl Iterator<Item = Cell<'a>>) -> ArrayRef {
    match kind {
        Kind::Count => {
            let count = |cell| {
                if let Cell::Count(count) = cell {
                    Some(count)
                } else {
                    None
                }
            };
            Arc::new(cells.map(count).collect::<UInt64Array>())
        }
        Kind::Number => {
            let number = |cell| {
                if let Cell::Number(number) = cell {
                    Some(number)
                } else {
                    None
                }
            };
            Arc::new(cells.map(number).collect::<Float64Array>())
        }
        Kind::Text => {
            let text = |cell| {
                if let Cell::Text(text) = cell {
                    Some(text)
                } else {
                    None
                }
            };
            Arc::new(cells.map(text).collect::<StringArray>())
        }
        Kind::Flag => {
            let flag = |cell| {
                if let Cell::Flag(flag) = cell {
                    Some(flag)
                } else {
                    None
                }
            };
            Arc::new(cells.map(flag).collect::<BooleanArray>())
        }
    }
}

/// Converts an error of the Parquet writer; a system error keeps its kind, so that callers recognise a
/// full disk.
pub fn parquet_error(error: ParquetError) -> io::Error {
    match error {
        ParquetError::External(inner) => match inner.downcast::<io::Error>() {
            Ok(error) => *error,
            Err(other) => io::Error::other(other),
        },
        other => io::Error::other(other),
    }
}

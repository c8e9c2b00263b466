//! Traces as Parquet, with units and the config in its metadata.

use crate::table::FORMAT;
use crate::table::{self, Row};
use crate::trace::Trace;
use arrow_array::RecordBatch;
use arrow_schema::Schema;
use coinmc::plan::Plan;
use coinmc::results::{arrow_array, arrow_field, parquet_error};
use parquet::arrow::ArrowWriter;
use parquet::basic::Compression;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use serde_json::Value;
use std::io::{self, Write};
use std::sync::Arc;

/// Writes the table of records, one row group per toss. The same traces give the same bytes.
///
/// # Errors
/// Errors of `out`.
pub fn write_parquet(
    plan: &Plan,
    traces: &[Trace],
    out: &mut (dyn Write + Send),
) -> io::Result<()> {
    let fields = table::columns()
        .iter()
        .map(|c| arrow_field(c.name, c.kind, c.unit, c.doc));
    let schema = Arc::new(Schema::new(fields.collect::<Vec<_>>()));
    let properties = WriterProperties::builder()
        .set_created_by(format!("coinmc {}", env!("CARGO_PKG_VERSION")))
        .set_compression(Compression::SNAPPY)
        .set_key_value_metadata(Some(metadata(plan, traces)))
        .build();
    let mut writer =
        ArrowWriter::try_new(out, Arc::clone(&schema), Some(properties)).map_err(parquet_error)?;
    for trace in traces {
        let rows: Vec<Row<'_>> = table::rows(std::slice::from_ref(trace)).collect();
        let columns = table::columns().iter();
        let arrays =
            columns.map(|column| arrow_array(column.kind, rows.iter().map(|r| column.cell(r))));
        let batch = RecordBatch::try_new(Arc::clone(&schema), arrays.collect());
        writer
            .write(&batch.map_err(io::Error::other)?)
            .and_then(|()| writer.flush())
            .map_err(parquet_error)?;
    }
    writer.close().map(drop).map_err(parquet_error)
}

fn metadata(plan: &Plan, traces: &[Trace]) -> Vec<KeyValue> {
    let entry = |key: &str, value: &str| KeyValue::new(format!("coinmc.{key}"), value.to_owned());
    let tosses: Vec<Value> = traces.iter().map(|trace| trace.to_json(plan)).collect();
    vec![
        entry("trace_format", &FORMAT.to_string()),
        entry("program_version", env!("CARGO_PKG_VERSION")),
        entry("plan_hash", &plan.hash()),
        entry("config", &plan.resolved_toml),
        entry("tosses", &Value::Array(tosses).to_string()),
    ]
}

//! The points of a design and what was tossed there, as a table.

use arrow_array::{ArrayRef, Float32Array, RecordBatch, UInt64Array};
use arrow_schema::{DataType, Field, Schema};
use coinmc::results::{Kind, Results, Row, arrow_field, parquet_error};
use coinmc_atlas::Place;
use parquet::arrow::ArrowWriter;
use parquet::basic::Compression;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use std::io::{self, Write};
use std::sync::Arc;

/// How a count of a row is found.
type Count = fn(&Row) -> u64;

/// The counts of a point.
const COUNTS: [(&str, &str, Count); 4] = [
    ("heads", "tosses that showed heads", |row| row.tally.heads),
    ("tails", "tosses that showed tails", |row| row.tally.tails),
    ("side", "tosses that showed the side", |row| row.tally.side),
    ("undecided", "tosses that showed no face", |row| {
        row.tally.undecided()
    }),
];

/// Writes coins, surfaces (in single precision, as networks are fitted to them) and counts as Parquet, with the
/// configs in its metadata. The same results give the same
/// bytes.
///
/// # Errors
/// Those of `out`.
pub(super) fn write_points(results: &[Results], out: &mut (dyn Write + Send)) -> io::Result<()> {
    let mut fields: Vec<Field> = Vec::new();
    let mut arrays: Vec<ArrayRef> = Vec::new();
    let mut properties = WriterProperties::builder();
    let entry = |key: &str, value: &str| KeyValue::new(format!("coinmc.{key}"), value.to_owned());
    let configs: Vec<&str> = results
        .iter()
        .map(|results| results.config.as_str())
        .collect();
    let rows = || results.iter().flat_map(|results| results.rows.each());
    for name in Place::NAMES {
        fields.push(Field::new(name, DataType::Float32, true));
        let values = rows().map(|row| row.parameter(name).map(single));
        arrays.push(Arc::new(values.collect::<Float32Array>()));
        // no two values are alike
        properties = properties.set_column_dictionary_enabled(name.into(), false);
    }
    for (name, doc, count) in COUNTS {
        fields.push(arrow_field(name, Kind::Count, "1", doc));
        let values = rows().map(|row| count(&row));
        arrays.push(Arc::new(values.collect::<UInt64Array>()));
    }
    let properties = properties
        .set_created_by(format!("coinmc {}", env!("CARGO_PKG_VERSION")))
        .set_compression(Compression::SNAPPY)
        .set_key_value_metadata(Some(vec![
            entry("atlas_format", "1"),
            entry("configs", &configs.join("\n")),
        ]))
        .build();
    let schema = Arc::new(Schema::new(fields));
    let batch = RecordBatch::try_new(Arc::clone(&schema), arrays).map_err(io::Error::other)?;
    let mut writer = ArrowWriter::try_new(out, schema, Some(properties)).map_err(parquet_error)?;
    writer.write(&batch).map_err(parquet_error)?;
    writer.close().map(drop).map_err(parquet_error)
}

#[allow(
    clippy::cast_possible_truncation,
    reason = "networks are fitted to numbers of single precision"
)]
fn single(x: f64) -> f32 {
    x as f32
}

//! The points of designs and what was tossed there, as a table.

use anyhow::{Context, ensure};
use arrow_array::{Array, ArrayRef, Float32Array, RecordBatch, UInt64Array};
use arrow_schema::{DataType, Field, Schema};
use coinmc::results::{Kind, arrow_field, parquet_error};
use coinmc_atlas::{Counts, Design, Place};
use parquet::arrow::ArrowWriter;
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use parquet::basic::Compression;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use std::fs::File;
use std::io::{self, Write};
use std::path::Path;
use std::sync::Arc;

/// Version of the table.
const FORMAT: &str = "2";

/// The column that tells which of the configs a point was tossed with.
const DESIGN: &str = "design";
/// Most rows that are read.
const MOST_ROWS: i64 = 10_000_000;

/// How a count is found.
type Count = fn(&Counts) -> u64;

/// The counts of a point.
const COUNTS: [(&str, &str, Count); 4] = [
    ("heads", "tosses that showed heads", |counts| {
        counts.faces[0]
    }),
    ("tails", "tosses that showed tails", |counts| {
        counts.faces[1]
    }),
    ("side", "tosses that showed the side", |counts| {
        counts.faces[2]
    }),
    ("undecided", "tosses that showed no face", |counts| {
        counts.undecided
    }),
];

/// Writes coins, surfaces (in single precision, as networks are fitted to them) and counts as Parquet, with the
/// configs in its metadata. The same designs give the same bytes.
///
/// # Errors
/// Those of `out`.
pub(super) fn write_points(designs: &[Design], out: &mut (dyn Write + Send)) -> io::Result<()> {
    let mut fields: Vec<Field> = Vec::new();
    let mut arrays: Vec<ArrayRef> = Vec::new();
    let mut properties = WriterProperties::builder();
    let rows = || designs.iter().flat_map(Design::points);
    for (i, name) in Place::NAMES.into_iter().enumerate() {
        fields.push(Field::new(name, DataType::Float32, false));
        let values = rows().map(|(place, _)| single(place.numbers()[i]));
        arrays.push(Arc::new(values.collect::<Float32Array>()));
        // no two values are alike
        properties = properties.set_column_dictionary_enabled(name.into(), false);
    }
    for (name, doc, count) in COUNTS {
        fields.push(arrow_field(name, Kind::Count, "1", doc));
        let values = rows().map(|(_, counts)| count(counts));
        arrays.push(Arc::new(values.collect::<UInt64Array>()));
    }
    let doc = "number of its config, coinmc.config_N in the metadata";
    fields.push(arrow_field(DESIGN, Kind::Count, "1", doc));
    let numbers = designs.iter().zip(1..);
    let numbers = numbers.flat_map(|(design, number)| design.points().iter().map(move |_| number));
    arrays.push(Arc::new(numbers.collect::<UInt64Array>()));
    let entry = |key: &str, value: &str| KeyValue::new(format!("coinmc.{key}"), value.to_owned());
    let mut entries = vec![entry("atlas_format", FORMAT)];
    for (design, number) in designs.iter().zip(1..) {
        entries.push(entry(&config_key(number), design.config()));
    }
    let properties = properties
        .set_created_by(format!("coinmc {}", env!("CARGO_PKG_VERSION")))
        .set_compression(Compression::SNAPPY)
        .set_key_value_metadata(Some(entries))
        .build();
    let schema = Arc::new(Schema::new(fields));
    let batch = RecordBatch::try_new(Arc::clone(&schema), arrays).map_err(io::Error::other)?;
    let mut writer = ArrowWriter::try_new(out, schema, Some(properties)).map_err(parquet_error)?;
    writer.write(&batch).map_err(parquet_error)?;
    writer.close().map(drop).map_err(parquet_error)
}

/// Reads the designs of such a table.
///
/// # Errors
/// What is missing, or why it cannot be read.
pub(super) fn read_points(path: &Path) -> anyhow::Result<Vec<Design>> {
    let reader = ParquetRecordBatchReaderBuilder::try_new(File::open(path)?)?;
    let metadata = reader.metadata().file_metadata();
    ensure!(
        metadata.num_rows() <= MOST_ROWS,
        "more than {MOST_ROWS} rows"
    );
    let entries = metadata.key_value_metadata().cloned().unwrap_or_default();
    let entry = |key: &str| {
        let mut entries = entries.iter();
        let found = entries.find(|entry| entry.key.strip_prefix("coinmc.") == Some(key));
        found.and_then(|entry| entry.value.clone())
    };
    ensure!(
        entry("atlas_format").as_deref() == Some(FORMAT),
        "it is no table of an atlas"
    );
    let configs = (1..).map_while(|number| entry(&config_key(number)));
    let mut designs: Vec<(String, Vec<(Place, Counts)>)> =
        configs.map(|config| (config, Vec::new())).collect();
    for batch in reader.build()? {
        let batch = batch?;
        let columns = Columns::of(&batch)?;
        for row in 0..batch.num_rows() {
            let number = usize::try_from(columns.design.value(row))?;
            let design = number.checked_sub(1).and_then(|i| designs.get_mut(i));
            let (_, points) = design.context("a point has no config")?;
            points.push(columns.point(row));
        }
    }
    let designs = designs.into_iter();
    Ok(designs
        .map(|(config, points)| Design::new(config, points))
        .collect::<Result<_, _>>()?)
}

/// The columns of a part of a table.
struct Columns<'a> {
    place: [&'a Float32Array; Place::NAMES.len()],
    counts: [&'a UInt64Array; COUNTS.len()],
    design: &'a UInt64Array,
}

impl<'a> Columns<'a> {
    fn of(batch: &'a RecordBatch) -> anyhow::Result<Self> {
        let mut place = Vec::new();
        for name in Place::NAMES {
            place.push(column(batch, name)?);
        }
        let mut counts = Vec::new();
        for (name, ..) in COUNTS {
            counts.push(column(batch, name)?);
        }
        Ok(Self {
            place: place.try_into().expect("one for each name"),
            counts: counts.try_into().expect("one for each count"),
            design: column(batch, DESIGN)?,
        })
    }

    fn point(&self, row: usize) -> (Place, Counts) {
        let [heads, tails, side, undecided] = self.counts.map(|column| column.value(row));
        let counts = Counts {
            faces: [heads, tails, side],
            undecided,
        };
        (
            Place::of(self.place.map(|column| column.value(row).into())),
            counts,
        )
    }
}

fn column<'a, T: Array + 'static>(batch: &'a RecordBatch, name: &str) -> anyhow::Result<&'a T> {
    let column = batch.column_by_name(name);
    let column = column.and_then(|column| column.as_any().downcast_ref::<T>());
    let column = column.with_context(|| format!("no column `{name}` of the usual type"))?;
    ensure!(column.null_count() == 0, "`{name}` has gaps");
    Ok(column)
}

fn config_key(number: usize) -> String {
    format!("config_{number}")
}

#[allow(
    clippy::cast_possible_truncation,
    reason = "networks are fitted to numbers of single precision"
)]
fn single(x: f64) -> f32 {
    x as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_atlas::Launch;

    fn designs() -> Vec<Design> {
        let config = |seed: u64| {
            let design = Launch::Hand.design();
            format!("seed = {seed}\n{design}")
        };
        let point = |i: u64| {
            let place = Place::of([0.8, 0.5, 0.3, 0.01, 0.001, 0.02, 1e-3 * (1.0 + i as f64)]);
            let counts = Counts {
                faces: [10 + i, 20, 30],
                undecided: i,
            };
            (place, counts)
        };
        [(1, 3), (3, 2)]
            .map(|(seed, points)| {
                let points = (0..points).map(|i| point(i + seed)).collect();
                Design::new(config(seed), points).unwrap()
            })
            .into()
    }

    #[test]
    fn a_table_is_read_as_it_was_written() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("points.parquet");
        write_points(&designs(), &mut File::create_new(&path).unwrap()).unwrap();
        assert_eq!(read_points(&path).unwrap(), designs());
    }

    #[test]
    fn tables_that_are_none_are_refused() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("points.parquet");
        std::fs::write(&path, b"PAR1 and no more").unwrap();
        assert!(read_points(&path).is_err());
        let mut whole = Vec::new();
        write_points(&designs(), &mut whole).unwrap();
        std::fs::write(&path, &whole[..whole.len() / 2]).unwrap();
        assert!(read_points(&path).is_err());
    }
}

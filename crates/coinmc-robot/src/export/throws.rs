//! The table of throws: one row per throw.

use crate::Experiment;
use crate::journal::{History, Resolution, Throw};
use arrow_array::{ArrayRef, Float64Array, RecordBatch, StringArray, UInt64Array};
use arrow_schema::{ArrowError, DataType, Field, Schema};
use coinmc::engines::EngineError;
use parquet::arrow::ArrowWriter;
use parquet::basic::Compression;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use std::io::{self, Write};
use std::sync::Arc;

/// Version of the table's format.
const FORMAT: u32 = 1;

/// A row of the table.
#[derive(Debug, Clone, PartialEq)]
pub struct ThrowRow {
    /// Number of the throw in the plan, from 0.
    pub number: u64,
    /// The throw according to the journal.
    pub throw: Throw,
    /// The face that the config's engine predicts for the same setting; `None` if undecided.
    pub model_face: Option<&'static str>,
}

/// The rows of all throws that are resolved.
///
/// # Errors
/// [`EngineError`] if the engine rejects its settings.
pub fn rows(experiment: &Experiment, history: &History) -> Result<Vec<ThrowRow>, EngineError> {
    let resolved = (0..).zip(history.throws());
    let resolved = resolved.filter(|(_, throw)| throw.resolution.is_some());
    resolved
        .map(|(number, throw)| {
            let face = experiment.model_face(number, throw.setting)?;
            Ok(ThrowRow {
                number: u64::from(number),
                throw: throw.clone(),
                model_face: face.map(coinmc_core::Face::name),
            })
        })
        .collect()
}

/// A column: name, unit, description and cells.
struct Column {
    name: &'static str,
    unit: &'static str,
    doc: &'static str,
    cell: Cells,
}

enum Cells {
    Count(fn(&ThrowRow) -> Option<u64>),
    Number(fn(&ThrowRow) -> Option<f64>),
    Text(fn(&ThrowRow) -> Option<String>),
}

/// The only definition of the table; CSV, Parquet and docs/guide/robot.md follow it.
const COLUMNS: [Column; 13] = [
    Column {
        name: "throw",
        unit: "1",
        doc: "Number in the plan, from 0.",
        cell: Cells::Count(|row| Some(row.number)),
    },
    Column {
        name: "id",
        unit: "1",
        doc: "Number on the link and in the journal.",
        cell: Cells::Count(|row| Some(u64::from(row.throw.id))),
    },
    Column {
        name: "spin_rev_s",
        unit: "rev/s",
        doc: "Requested spin.",
        cell: Cells::Number(|row| Some(row.throw.setting.spin_rev_s())),
    },
    Column {
        name: "angle_deg",
        unit: "deg",
        doc: "Requested start angle.",
        cell: Cells::Number(|row| Some(row.throw.setting.angle_deg())),
    },
    Column {
        name: "face",
        unit: "",
        doc: "heads, tails or side; empty for a void throw.",
        cell: Cells::Text(|row| {
            let (reading, _) = row.throw.reading.as_ref()?;
            Some(reading.face.name().to_owned())
        }),
    },
    Column {
        name: "void",
        unit: "",
        doc: "Why a throw has no result; empty for a done one.",
        cell: Cells::Text(|row| match row.throw.resolution {
            Some(Resolution::Void(reason)) => Some(reason.to_string()),
            _ => None,
        }),
    },
    Column {
        name: "model_face",
        unit: "",
        doc: "Face that the config's engine gives for the same spin and angle; empty if undecided.",
        cell: Cells::Text(|row| row.model_face.map(str::to_owned)),
    },
    Column {
        name: "measured_spin_rev_s",
        unit: "rev/s",
        doc: "Spin at release as the robot measured it.",
        cell: Cells::Number(|row| {
            let (reading, _) = row.throw.reading.as_ref()?;
            Some(f64::from(reading.measured.spin_mrev_s) / 1e3)
        }),
    },
    Column {
        name: "measured_angle_deg",
        unit: "deg",
        doc: "Start angle at release as the robot measured it.",
        cell: Cells::Number(|row| {
            let (reading, _) = row.throw.reading.as_ref()?;
            Some(f64::from(reading.measured.angle_cdeg) / 1e2)
        }),
    },
    Column {
        name: "boot",
        unit: "1",
        doc: "The robot's count of its starts.",
        cell: Cells::Count(|row| Some(u64::from(row.throw.reading.as_ref()?.0.boot))),
    },
    Column {
        name: "announced_ms",
        unit: "ms",
        doc: "Time of the host when the throw was announced, since 1970.",
        cell: Cells::Count(|row| Some(row.throw.announced_ms)),
    },
    Column {
        name: "read_ms",
        unit: "ms",
        doc: "Time of the host when the photo was read, since 1970.",
        cell: Cells::Count(|row| Some(row.throw.reading.as_ref()?.1)),
    },
    Column {
        name: "image",
        unit: "",
        doc: "Name of the photo in the folder photos.",
        cell: Cells::Text(|row| {
            let (reading, _) = row.throw.reading.as_ref()?;
            Some(reading.image.as_str().to_owned())
        }),
    },
];

/// Writes the table as CSV with a header line; missing values are empty cells.
///
/// # Errors
/// Errors of `out`.
pub fn write_throws_csv(rows: &[ThrowRow], mut out: impl Write) -> io::Result<()> {
    let names: Vec<&str> = COLUMNS.iter().map(|column| column.name).collect();
    writeln!(out, "{}", names.join(","))?;
    for row in rows {
        let cells: Vec<String> = COLUMNS
            .iter()
            .map(|column| match column.cell {
                Cells::Count(cell) => cell(row).map(|count| count.to_string()),
                Cells::Number(cell) => cell(row).map(|number| number.to_string()),
                // names of faces, reasons and photos never contain a comma or a quote
                Cells::Text(cell) => cell(row),
            })
            .map(Option::unwrap_or_default)
            .collect();
        writeln!(out, "{}", cells.join(","))?;
    }
    Ok(())
}

/// The table in memory, with units and descriptions in its schema.
///
/// # Errors
/// [`ArrowError`] if the table is too large for Arrow.
pub fn throws_batch(rows: &[ThrowRow]) -> Result<RecordBatch, ArrowError> {
    let schema = Schema::new(COLUMNS.iter().map(field).collect::<Vec<_>>());
    let arrays = COLUMNS.iter().map(|column| array(column, rows)).collect();
    RecordBatch::try_new(Arc::new(schema), arrays)
}

/// Writes the table as Parquet, with units, descriptions and the config in its metadata.
///
/// # Errors
/// Errors of `out`.
pub fn write_throws_parquet(
    rows: &[ThrowRow],
    experiment: &Experiment,
    out: &mut (dyn Write + Send),
) -> io::Result<()> {
    let batch = throws_batch(rows).map_err(io::Error::other)?;
    let entry = |key: &str, value: String| KeyValue::new(format!("coinmc.{key}"), value);
    let plan = experiment.plan();
    let properties = WriterProperties::builder()
        .set_created_by(concat!("coinmc ", env!("CARGO_PKG_VERSION")).to_owned())
        .set_compression(Compression::SNAPPY)
        .set_key_value_metadata(Some(vec![
            entry("throws_format", FORMAT.to_string()),
            entry("plan_hash", plan.hash()),
            entry("config", plan.resolved_toml.clone()),
        ]))
        .build();
    let mut writer =
        ArrowWriter::try_new(out, batch.schema(), Some(properties)).map_err(io::Error::other)?;
    writer.write(&batch).map_err(io::Error::other)?;
    writer.close().map(drop).map_err(io::Error::other)
}

fn field(column: &Column) -> Field {
    let kind = match column.cell {
        Cells::Count(_) => DataType::UInt64,
        Cells::Number(_) => DataType::Float64,
        Cells::Text(_) => DataType::Utf8,
    };
    let metadata = [("unit", column.unit), ("description", column.doc)]
        .into_iter()
        .filter(|(_, text)| !text.is_empty())
        .map(|(key, text)| (key.to_owned(), text.to_owned()));
    Field::new(column.name, kind, true).with_metadata(metadata.collect())
}

fn array(column: &Column, rows: &[ThrowRow]) -> ArrayRef {
    match column.cell {
        Cells::Count(cell) => Arc::new(rows.iter().map(cell).collect::<UInt64Array>()),
        Cells::Number(cell) => Arc::new(rows.iter().map(cell).collect::<Float64Array>()),
        Cells::Text(cell) => Arc::new(rows.iter().map(cell).collect::<StringArray>()),
    }
}

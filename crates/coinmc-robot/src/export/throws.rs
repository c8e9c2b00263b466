//! The table of throws: one row per throw.

use crate::Experiment;
use crate::journal::{History, Resolution, Throw};
use coinmc::engines::EngineError;
use coinmc_table::{About, Cell, Field, Kind, ParquetTable};
use std::io::{self, Write};

/// Version of the table's format.
const FORMAT: u32 = 1;

/// A row of the table.
#[derive(Debug, Clone, PartialEq)]
pub struct ThrowRow {
    /// Number of the throw in the plan, from 0.
    pub number: u64,
    /// The throw according to the journal.
    pub throw: Throw,
    /// Why the throw has no result, in the words of the journal: made once, so that cells can borrow it.
    void: Option<String>,
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
            let void = match throw.resolution {
                Some(Resolution::Void(reason)) => Some(reason.to_string()),
                _ => None,
            };
            Ok(ThrowRow {
                number: u64::from(number),
                void,
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
    Text(fn(&ThrowRow) -> Option<&str>),
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
            Some(reading.face.name())
        }),
    },
    Column {
        name: "void",
        unit: "",
        doc: "Why a throw has no result; empty for a done one.",
        cell: Cells::Text(|row| row.void.as_deref()),
    },
    Column {
        name: "model_face",
        unit: "",
        doc: "Face that the config's engine gives for the same spin and angle; empty if undecided.",
        cell: Cells::Text(|row| row.model_face),
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
            Some(reading.image.as_str())
        }),
    },
];

/// The columns of the table.
pub fn throws_fields() -> Vec<Field> {
    COLUMNS.iter().map(field).collect()
}

/// The cell of a row in the column with this index.
///
/// # Panics
/// If there is no such column.
pub fn throws_cell(row: &ThrowRow, column: usize) -> Cell<'_> {
    match COLUMNS[column].cell {
        Cells::Count(cell) => cell(row).map_or(Cell::Missing, Cell::Count),
        Cells::Number(cell) => cell(row).map_or(Cell::Missing, Cell::Number),
        Cells::Text(cell) => cell(row).map_or(Cell::Missing, Cell::Text),
    }
}

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
                Cells::Text(cell) => cell(row).map(str::to_owned),
            })
            .map(Option::unwrap_or_default)
            .collect();
        writeln!(out, "{}", cells.join(","))?;
    }
    Ok(())
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
    let plan = experiment.plan();
    let about = About::coinmc(env!("CARGO_PKG_VERSION")).with_entries([
        ("coinmc.throws_format", FORMAT.to_string()),
        ("coinmc.plan_hash", plan.hash()),
        ("coinmc.config", plan.resolved_toml.clone()),
    ]);
    let mut table = ParquetTable::new(throws_fields(), about, out)?;
    table.write_group(&rows.iter(), throws_cell)?;
    table.finish()
}

fn field(column: &Column) -> Field {
    let kind = match column.cell {
        Cells::Count(_) => Kind::Count,
        Cells::Number(_) => Kind::Number,
        Cells::Text(_) => Kind::Text,
    };
    Field::new(column.name, kind, column.unit, column.doc).with_optional(true)
}

//! `coinmc film read`: the interpretation of a file.

use super::files::Columns;
use crate::exit::{Failure, Outcome};
use crate::output::{self, Console, FORMAT_VERSION, Format};
use clap::Args;
use coinmc_film::Coordinate;
use coinmc_film::text::Footage;
use serde_json::{Value, json};
use std::path::PathBuf;

/// Show how Tracker's files are interpreted
#[derive(Debug, Args)]
pub(super) struct Read {
    /// Text files exported by Tracker
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,

    #[command(flatten)]
    columns: Columns,

    /// Format of the result
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,
}

impl Read {
    pub(super) fn format(&self) -> Format {
        self.format
    }

    pub(super) fn execute(&self, _: &Console) -> Result<Outcome, Failure> {
        let footage = self.columns.read(&self.files)?;
        let printed = match self.format {
            Format::Json => output::print_json(&json!({
                "format_version": FORMAT_VERSION,
                "kind": "film",
                "drops": footage.iter().map(to_json).collect::<Vec<_>>(),
            })),
            Format::Table => {
                let texts: Vec<String> = footage.iter().map(to_text).collect();
                output::print(&texts.join("\n"))
            }
        };
        printed.map_err(|error| Failure::Runtime(error.into()))?;
        Ok(Outcome::Done)
    }
}

/// First and last time, s.
fn span(footage: &Footage) -> (f64, f64) {
    let frames = &footage.drop.frames;
    let time = |frame: Option<&coinmc_film::Frame>| frame.map_or(0.0, |frame| frame.time_s);
    (time(frames.first()), time(frames.last()))
}

fn to_text(footage: &Footage) -> String {
    let (first, last) = span(footage);
    let dialect = footage.dialect;
    let all: Vec<String> = footage
        .columns
        .iter()
        .map(coinmc_film::text::Column::full_name)
        .collect();
    let mark = if dialect.decimal_comma {
        "comma"
    } else {
        "point"
    };
    let mut text = format!(
        "{}: {} frames, {first:.3} to {last:.3} s, {:.1} frames/s\n  {}, {} between cells, decimal {mark}\n  \
         columns {}\n  read {}\n",
        footage.drop.name,
        footage.drop.frames.len(),
        footage.drop.rate_hz(),
        dialect.encoding.name(),
        dialect.delimiter.name(),
        all.join(", "),
        footage.used.join(", "),
    );
    for coordinate in Coordinate::ALL {
        let seen = footage
            .drop
            .frames
            .iter()
            .filter_map(|f| f.seen[coordinate as usize]);
        let (low, high) = seen.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        let missing = footage.missing[coordinate as usize];
        let name = coordinate.name();
        if low > high {
            text += &format!("  {name}: not marked\n");
        } else {
            text += &format!("  {name}: {low:.4} to {high:.4}, {missing} not marked\n");
        }
    }
    text
}

fn to_json(footage: &Footage) -> Value {
    let (first, last) = span(footage);
    json!({
        "file": footage.drop.name,
        "frames": footage.drop.frames.len(),
        "first_s": first,
        "last_s": last,
        "rate_hz": footage.drop.rate_hz(),
        "encoding": footage.dialect.encoding.name(),
        "delimiter": footage.dialect.delimiter.name(),
        "decimal_comma": footage.dialect.decimal_comma,
        "columns": footage.columns.iter().map(|column| json!({
            "track": column.track,
            "name": column.name,
            "unit": column.unit,
        })).collect::<Vec<_>>(),
        "read": footage.used,
        "not_marked": {
            "x_m": footage.missing[0],
            "z_m": footage.missing[1],
            "theta_rad": footage.missing[2],
        },
    })
}

//! `coinmc status`: how far runs are.

use super::report::unreadable;
use crate::exit::{Failure, Outcome};
use crate::output::{self, Console, FORMAT_VERSION, Format};
use crate::terminal::progress::Progress;
use crate::terminal::{count, grouped};
use clap::Args;
use coinmc::run::{Report, Status as Finished, is_running, stored_report};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  coinmc status runs/*
  coinmc status runs/first --format json";

/// Show how far runs are
///
/// A line for each run directory: finished, running, stopped or a complete part, with its points and tosses.
/// Nothing in them is changed.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Status {
    /// Run directories
    #[arg(value_name = "RUN_DIR", required = true)]
    runs: Vec<PathBuf>,

    /// How to write the result
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,
}

/// How far a run is.
struct Row {
    run: PathBuf,
    state: &'static str,
    points: usize,
    points_done: usize,
    tosses: u64,
    tosses_planned: u64,
    half_width: f64,
}

impl Status {
    pub(crate) fn format(&self) -> Format {
        self.format
    }

    pub(crate) fn execute(&self, console: &Console) -> Result<Outcome, Failure> {
        let progress = Progress::new(*console.stderr(), true);
        let rows = self.runs.iter().map(|run| {
            // before the counts are read: a run that ends in the meantime is then called running
            let runs = is_running(run);
            let (_, report) = stored_report(run, &progress).map_err(unreadable)?;
            Ok(Row::new(run, runs, &report))
        });
        let rows: Vec<Row> = rows.collect::<Result<_, Failure>>()?;
        let printed = match self.format {
            Format::Json => output::print_json(&json!({
                "format_version": FORMAT_VERSION,
                "kind": "status",
                "runs": rows.iter().map(Row::to_json).collect::<Vec<_>>(),
            })),
            Format::Table => output::print(&rows.iter().map(Row::line).collect::<String>()),
        };
        printed.map_err(|error| Failure::Runtime(error.into()))?;
        Ok(Outcome::Done)
    }
}

impl Row {
    fn new(run: &Path, runs: bool, report: &Report) -> Self {
        let rows = &report.results.rows;
        let is_finished = matches!(
            report.status,
            Finished::Complete | Finished::ShortOfTarget { .. }
        );
        let state = match (report.status, runs) {
            (Finished::Complete | Finished::ShortOfTarget { .. }, _) => "finished",
            (Finished::Part, _) => "part",
            (Finished::Interrupted, true) => "running",
            (Finished::Interrupted, false) => "stopped",
        };
        Self {
            run: run.to_owned(),
            state,
            points: rows.len(),
            points_done: if is_finished {
                rows.len()
            } else {
                report.points_reached()
            },
            tosses: report.tosses,
            tosses_planned: report.tosses_planned,
            half_width: rows.each().map(|row| row.half_width()).fold(0.0, f64::max),
        }
    }

    /// `runs/first: stopped, 1 of 3 points, 20 000 of 60 000 tosses (33 %), widest interval ± 0.007`
    fn line(&self) -> String {
        let Self {
            state,
            points_done,
            tosses,
            tosses_planned,
            ..
        } = self;
        let points = count(self.points as u64, "point");
        let state = if *state == "part" {
            "a complete part"
        } else {
            state
        };
        let mut line = format!("{}: {state}, ", self.run.display());
        if *points_done < self.points {
            line += &format!("{} of ", grouped(*points_done as u64));
        }
        line += &format!("{points}, {}", grouped(*tosses));
        if tosses < tosses_planned {
            let share = 100.0 * *tosses as f64 / *tosses_planned as f64;
            line += &format!(" of {} tosses ({share:.0} %)", grouped(*tosses_planned));
        } else {
            line += " tosses";
        }
        if *tosses > 0 {
            line += &format!(", widest interval ± {:.2e}", self.half_width);
        }
        line + "\n"
    }

    fn to_json(&self) -> Value {
        json!({
            "run": self.run.to_string_lossy(),
            "state": self.state,
            "points": self.points,
            "points_done": self.points_done,
            "tosses": self.tosses,
            "tosses_planned": self.tosses_planned,
            "half_width": self.half_width,
        })
    }
}

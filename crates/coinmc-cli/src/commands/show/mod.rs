//! `coinmc show`: the summary of a run again, and who made it.

mod made_by;
mod ro_crate;

use super::report::unreadable;
use super::run::{PART_IS_COMPLETE, show, to_json};
use crate::exit::{Failure, Outcome};
use crate::output::{self, Console, Format, ResultFormat};
use crate::terminal::count;
use crate::terminal::plot::Plotted;
use crate::terminal::progress::Progress;
use crate::terminal::summary::FAIR;
use anyhow::Context;
use clap::{Args, ValueEnum};
use coinmc::results::fair_ratios;
use coinmc::run::{Provenance, Report, Status, provenance, stored_report};
use serde_json::Value;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  coinmc show runs/first
  coinmc show runs/first --plot restitution,heads
  coinmc show runs/first --format json              the document of `coinmc run`, and who made it
  coinmc show runs/first --format ro-crate > runs/first/ro-crate-metadata.json
                                                    describe the directory for an archive (RO-Crate)";

/// Print the summary of a run again
///
/// Works for unfinished runs, too, and while another process runs in the directory. Nothing in it is changed.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Show {
    /// A run directory
    #[arg(value_name = "RUN_DIR")]
    run: PathBuf,

    /// What to plot: a swept parameter, a face, both (`friction,heads`), or `none`
    #[arg(long, value_name = "AXIS,FACE", default_value_t)]
    plot: Plotted,

    /// How to write the result
    #[arg(long, value_enum, default_value_t = ShowFormat::Table)]
    format: ShowFormat,
}

/// How a run is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum ShowFormat {
    /// For people
    Table,
    /// One JSON document
    Json,
    /// Every column of every point, as in results.csv
    Csv,
    /// The table for people, whole, to be pasted
    Markdown,
    /// Files, builds and machines of the run as JSON-LD, for archives
    RoCrate,
}

impl Show {
    pub(crate) fn format(&self) -> Format {
        match self.format {
            ShowFormat::Json | ShowFormat::RoCrate => Format::Json,
            ShowFormat::Table | ShowFormat::Csv | ShowFormat::Markdown => Format::Table,
        }
    }

    pub(crate) fn execute(&self, console: &Console) -> Result<Outcome, Failure> {
        let progress = Progress::new(*console.stderr(), true);
        let (plan, report) = stored_report(&self.run, &progress).map_err(unreadable)?;
        self.plot.check(&plan.axes).map_err(Failure::Input)?;
        let made_by = provenance(&self.run, &plan).map_err(unreadable)?;
        self.print(&report, &made_by, console)?;
        if self.format == ShowFormat::Table {
            for line in made_by::lines(&made_by) {
                output::note(&line);
            }
        }
        if let Some(remark) = unfinished(&report) {
            output::note(&format!("coinmc: {remark}"));
        }
        Ok(Outcome::Done)
    }

    /// The run on standard output.
    fn print(
        &self,
        report: &Report,
        made_by: &Provenance,
        console: &Console,
    ) -> Result<(), Failure> {
        let format = match self.format {
            ShowFormat::Table => ResultFormat::Table,
            ShowFormat::Csv => ResultFormat::Csv,
            ShowFormat::Markdown => ResultFormat::Markdown,
            ShowFormat::Json => {
                let fair = fair_ratios(&report.results, FAIR);
                let mut document = to_json(report, &fair, &self.run);
                document["made_by"] = made_by.to_json();
                document["unrecorded_chunks"] = made_by.unrecorded_chunks.into();
                return printed(&document);
            }
            ShowFormat::RoCrate => {
                let document = ro_crate::document(&self.run, report, made_by)
                    .with_context(|| format!("cannot read {}", self.run.display()));
                return printed(&document.map_err(Failure::Runtime)?);
            }
        };
        show(report, &self.run, &self.plot, console, format)
    }
}

fn printed(document: &Value) -> Result<(), Failure> {
    let printed = output::print_json(document);
    printed.map_err(|error| Failure::Runtime(error.into()))
}

/// What is missing of a run, if something is, in words.
pub(super) fn unfinished(report: &Report) -> Option<String> {
    let word = match report.status {
        Status::Complete => return None,
        Status::Part => return Some(PART_IS_COMPLETE.to_owned()),
        Status::Interrupted => "unfinished",
        Status::ShortOfTarget { .. } => "short of its targets",
    };
    let done = report.points_reached();
    let all = count(report.results.rows.len() as u64, "point");
    Some(format!("this run is {word}: {done} of {all} finished"))
}

//! `coinmc show`: the summary of a run again.

use super::report::unreadable;
use super::run::show;
use crate::exit::{Failure, Outcome};
use crate::output::{self, Console, Format, ResultFormat};
use crate::terminal::count;
use crate::terminal::plot::Plotted;
use crate::terminal::progress::Progress;
use clap::Args;
use coinmc::run::{Status, stored_report};
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  coinmc show runs/first
  coinmc show runs/first --plot restitution,heads
  coinmc show runs/first --format json              the same document as of `coinmc run`";

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
    #[arg(long, value_enum, default_value_t = ResultFormat::Table)]
    format: ResultFormat,
}

impl Show {
    pub(crate) fn format(&self) -> Format {
        self.format.of_failures()
    }

    pub(crate) fn execute(&self, console: &Console) -> Result<Outcome, Failure> {
        let progress = Progress::new(*console.stderr(), true);
        let (plan, report) = stored_report(&self.run, &progress).map_err(unreadable)?;
        self.plot.check(&plan.axes).map_err(Failure::Input)?;
        show(&report, &self.run, &self.plot, console, self.format)?;
        let rows = &report.results.rows;
        let done = rows
            .each()
            .filter(|row| row.stopped_by.is_reached())
            .count();
        let unfinished = match report.status {
            Status::Complete | Status::Part => None,
            Status::Interrupted => Some("unfinished"),
            Status::ShortOfTarget { .. } => Some("short of its targets"),
        };
        if let Some(word) = unfinished {
            let all = count(rows.len() as u64, "point");
            output::note(&format!(
                "coinmc: this run is {word}: {done} of {all} finished"
            ));
        }
        Ok(Outcome::Done)
    }
}

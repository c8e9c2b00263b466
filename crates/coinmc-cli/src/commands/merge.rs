//! `coinmc merge`: merges the parts of a run.

use super::run::{present, show};
use crate::exit::{Failure, Outcome};
use crate::output::{self, Console, Format, ResultFormat};
use crate::terminal::count;
use crate::terminal::plot::Plotted;
use crate::terminal::progress::Progress;
use clap::Args;
use coinmc::run::Missing;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Example:
  coinmc run toss.toml --shard 1/2 --out part-1        on one machine
  coinmc run toss.toml --shard 2/2 --out part-2        on another
  coinmc merge part-1 part-2 --out whole               the same bytes as one run
  coinmc merge part-1 --out so-far --partial           what is there, while part 2/2 is missing";

/// Merge the parts of a run that `run --shard` divided
///
/// The parts are only read. Together they must make up the whole run, with the same plan and program
/// version; with --partial some may be missing.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Merge {
    /// Run directories of the parts
    #[arg(required = true, value_name = "DIR")]
    parts: Vec<PathBuf>,

    /// Run directory of the whole: new or empty
    #[arg(long, value_name = "DIR")]
    out: PathBuf,

    /// Merge what parts there are, and name those that are missing; exit status 3 if there are any
    #[arg(long)]
    partial: bool,

    /// How to write the result
    #[arg(long, value_enum, default_value_t = ResultFormat::Table)]
    format: ResultFormat,
}

impl Merge {
    pub(crate) fn format(&self) -> Format {
        self.format.of_failures()
    }

    pub(crate) fn execute(&self, console: &Console) -> Result<Outcome, Failure> {
        let progress = Progress::new(*console.stderr(), true);
        let (report, missing) = if self.partial {
            coinmc::run::merge_what_is_there(&self.parts, &self.out, &progress)?
        } else {
            let report = coinmc::run::merge(&self.parts, &self.out, &progress)?;
            (report, None)
        };
        let Some(missing) = missing else {
            let plotted = Plotted::default();
            return present(&report, &self.out, &plotted, console, self.format, false);
        };
        show(
            &report,
            &self.out,
            &Plotted::default(),
            console,
            self.format,
        )?;
        output::note(&self.advice(&missing));
        Ok(Outcome::ShortOfTarget)
    }

    /// What is missing, and what can be done.
    fn advice(&self, missing: &Missing) -> String {
        let of_parts = if missing.parts.is_empty() {
            String::new()
        } else {
            format!(": part {}", missing.names())
        };
        format!(
            "coinmc: merged without {}{of_parts}. Merge again into {} when all are there",
            count(missing.total, "chunk"),
            self.out.display()
        )
    }
}

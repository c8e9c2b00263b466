//! `coinmc merge`: merges the parts of a run.

use super::run::present;
use crate::exit::{Failure, Outcome};
use crate::output::{Console, Format, ResultFormat};
use crate::terminal::plot::Plotted;
use crate::terminal::progress::Progress;
use clap::Args;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Example:
  coinmc run toss.toml --shard 1/2 --out part-1        on one machine
  coinmc run toss.toml --shard 2/2 --out part-2        on another
  coinmc merge part-1 part-2 --out whole               the same bytes as one run";

/// Merge the parts of a run that `run --shard` divided
///
/// The parts are only read. Together they must make up the whole run, with the same plan and program
/// version.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Merge {
    /// Run directories of the parts
    #[arg(required = true, value_name = "DIR")]
    parts: Vec<PathBuf>,

    /// Run directory of the whole: new or empty
    #[arg(long, value_name = "DIR")]
    out: PathBuf,

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
        let report = coinmc::run::merge(&self.parts, &self.out, &progress)?;
        present(
            &report,
            &self.out,
            &Plotted::default(),
            console,
            self.format,
            false,
        )
    }
}

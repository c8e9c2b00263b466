//! `coinmc validate`: claims, public data sets and engines, each with its verdict.

mod report;

use super::new_file;
use super::page::{Page, Replaceable};
use super::question::{AnswerArgs, Unanswered, ask, write_file};
use crate::command_line::this_command;
use crate::exit::{Failure, Outcome};
use crate::output::{self, Console, Format};
use anyhow::anyhow;
use clap::Args;
use coinmc_questions::csv_of_rows;
use coinmc_validate::{self as validation, Options, Size, ValidateError, Validation};
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  coinmc validate                                   everything, in less than a minute on two cores
  coinmc validate --only mass,kerrich --show        some of it, with the numbers of each verdict
  coinmc validate --full --report claims.html       many more tosses; the same command goes on

Verdicts: holds, holds only where …, rejected, not validated. A claim is tested at 1 %. A data set is \
predicted by one prior over tables, hands and coins, in which nothing is fitted; its p-value holds the \
spread of the prior, the error of our own tosses and that of the counts.

The exit status is 0 whatever the verdicts are: they are the result. 1, 2 and 130 as always.";

/// Where a full validation keeps its runs.
const OUT: &str = "runs/validate-full";

/// Check claims, public data sets and engines, one by one
///
/// Claims are those of Gaek & Sukhov (arXiv 2401.03557), and that two ways to compute a toss agree.
/// What could not be validated is said, with the reason.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Validate {
    /// Only these claims and data sets, by name, separated by commas
    #[arg(long, value_name = "NAMES", value_delimiter = ',', value_parser = super::names::claims())]
    #[arg(hide_possible_values = true)]
    only: Vec<String>,

    /// Many more tosses, half an hour of one core; may be stopped and goes on
    #[arg(long)]
    full: bool,

    /// Directory in which all tosses are kept, so that the same command goes on
    /// [default: none; with --full runs/validate-full]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Key of all random numbers
    #[arg(long, value_name = "N", default_value = "1", value_parser = super::count)]
    seed: u64,

    /// Show the numbers that each verdict rests on
    #[arg(long)]
    show: bool,

    /// New file (.html) for a page of the verdicts
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,

    /// New file (.csv) for all verdicts and their numbers, one a line
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,

    #[command(flatten)]
    answer: AnswerArgs,
}

impl From<ValidateError> for Unanswered {
    fn from(error: ValidateError) -> Self {
        match error {
            ValidateError::Stopped => Self::Stopped,
            ValidateError::Run(error) => Self::Failed(error.into()),
            ValidateError::Question(error) => error.into(),
            ValidateError::Unknown { .. } | ValidateError::OtherDirectory { .. } => {
                Self::Failed(Failure::Input(error.into()))
            }
            ValidateError::Config(_) | ValidateError::Key(_) => {
                Self::Failed(Failure::Runtime(error.into()))
            }
        }
    }
}

impl Validate {
    pub(crate) fn format(&self) -> Format {
        self.answer.format
    }

    pub(crate) fn execute(&self, console: &Console) -> Result<Outcome, Failure> {
        let page = self.report.as_deref();
        let page = page.map(|path| Page::begin(path, Replaceable::Nothing));
        let page = page.transpose()?;
        let csv = new_file::begin(self.csv.as_deref(), "csv")?;
        let out = self.out();
        let found = ask(console, &self.answer, |workers| {
            let options = Options {
                size: if self.full { Size::Full } else { Size::Quick },
                only: &self.only,
                seed: self.seed,
                out,
                build: coinmc_build::BUILD,
            };
            validation::validate(&options, workers)
        });
        if let (Err(Failure::Interrupted), Some(out), false) = (&found, out, self.answer.quiet) {
            output::note(&format!(
                "coinmc: stopped; all finished tosses are kept in {}.\nGo on with: {}",
                out.display(),
                this_command()
            ));
        }
        let found = found?;
        let document = validation::document(&found);
        if let Some(page) = page {
            page.write(&coinmc_report::claims(&document))?;
        }
        if let Some(file) = csv {
            write_file(file, csv_of_rows(&validation::flat_rows(&document)))?;
        }
        self.present(&found, &document, console)
    }

    fn out(&self) -> Option<&Path> {
        let default = self.full.then_some(Path::new(OUT));
        self.out.as_deref().or(default)
    }

    fn present(
        &self,
        found: &Validation,
        document: &serde_json::Value,
        console: &Console,
    ) -> Result<Outcome, Failure> {
        match console.format() {
            Format::Json => output::print_json(document),
            Format::Table => output::print(&report::text(found, self.show, console.stdout())),
        }
        .map_err(|error| Failure::Runtime(anyhow!(error)))?;
        Ok(Outcome::Done)
    }
}

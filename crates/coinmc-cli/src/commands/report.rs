//! `coinmc report`: runs as a page that opens anywhere.

use super::page::{Page, Replaceable};
use crate::exit::{Failure, Outcome, several};
use crate::output::{self, Console, FORMAT_VERSION, Format};
use crate::terminal::grouped;
use crate::terminal::progress::Progress;
use anyhow::anyhow;
use clap::Args;
use coinmc::run::RunError;
use coinmc_report::{Run, Samples, report};
use serde_json::json;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  coinmc report runs/first -o report.html
  coinmc report runs/wood runs/felt -o tables.html --title 'Wood and felt'
  coinmc report runs/first -o report.html --point 2 --toss 0,1,2     which tosses it shows in 3D

The page is one file. It loads nothing from a network: copy it to a phone, or send it.";

/// Make a page of runs: plots, maps, tables, tosses in 3D
///
/// Shows P(face) along any axis with intervals and closed forms, maps over two axes, fair ratios,
/// convergence, how tosses ended, cost, published counts, all data, and how to have them again.
/// Several runs stand side by side; unfinished ones are reported as far as they are.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct ReportOf {
    /// Run directories
    #[arg(required = true, value_name = "RUN_DIR")]
    runs: Vec<PathBuf>,

    /// The page: a new file (.html)
    #[arg(short, long, value_name = "FILE", default_value = "report.html")]
    out: PathBuf,

    /// Replace FILE if it is an earlier page
    #[arg(long)]
    force: bool,

    /// Title [default: the names of the runs]
    #[arg(long, value_name = "TEXT")]
    title: Option<String>,

    /// The point whose tosses are shown in 3D [default: the one closest to P(side) = 1/3]
    #[arg(long, value_name = "P")]
    point: Option<usize>,

    /// The tosses that are shown in 3D, separated by commas
    /// [default: the first that shows each face]
    #[arg(long = "toss", value_name = "K", value_delimiter = ',', value_parser = super::count)]
    tosses: Vec<u64>,

    /// How to write what was done
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,
}

/// Most tosses of each run in 3D.
const MAX_TOSSES: usize = coinmc_report::MAX_TOSSES;

impl ReportOf {
    pub(crate) fn format(&self) -> Format {
        self.format
    }

    pub(crate) fn execute(&self, console: &Console) -> Result<Outcome, Failure> {
        if self.tosses.len() > MAX_TOSSES {
            return Err(Failure::Input(anyhow!(
                "a page shows at most {MAX_TOSSES} tosses of a run"
            )));
        }
        let replaceable = if self.force {
            Replaceable::AnyPage
        } else {
            Replaceable::Nothing
        };
        let page = Page::begin(&self.out, replaceable)?;
        let progress = Progress::new(*console.stderr(), true);
        let runs = self.open(&progress)?;
        let samples = Samples {
            point: self.point,
            tosses: self.tosses.clone(),
        };
        let text = report(&runs, self.title.as_deref(), &samples)?;
        page.write(&text)?;
        self.tell(text.len() as u64, console)
    }

    /// All runs, or what is wrong with every directory that holds none.
    fn open(&self, progress: &Progress) -> Result<Vec<Run>, Failure> {
        let (mut runs, mut failures) = (Vec::new(), Vec::new());
        for dir in &self.runs {
            match Run::open(dir, progress) {
                Ok(run) => runs.push(run),
                Err(error) => failures.push(unreadable(error)),
            }
        }
        if failures.is_empty() {
            return Ok(runs);
        }
        Err(several(failures.into_iter()))
    }

    fn tell(&self, bytes: u64, console: &Console) -> Result<Outcome, Failure> {
        match console.format() {
            Format::Json => output::print_json(&json!({
                "format_version": FORMAT_VERSION,
                "kind": "report",
                "out": self.out.to_string_lossy(),
                "bytes": bytes,
            })),
            Format::Table => {
                let kilobytes = grouped(bytes.div_ceil(1000));
                output::print(&format!(
                    "Report: {} ({kilobytes} kB)\n",
                    self.out.display()
                ))
            }
        }
        .map_err(|error| Failure::Runtime(error.into()))?;
        Ok(Outcome::Done)
    }
}

/// Why a run directory cannot be read.
pub(super) fn unreadable(error: RunError) -> Failure {
    match error {
        RunError::OtherVersion { dir, theirs, ours } => Failure::Input(anyhow!(
            "{} is a run of coinmc {theirs}, this is {ours}: its tosses may be others. Read it with {theirs}, or \
             run the config.toml found there again",
            dir.display()
        )),
        error => error.into(),
    }
}

//! `coinmc report`: runs as a page that opens anywhere.

use super::new_file::must_end_in;
use super::question::write_file;
use crate::exit::{Failure, Outcome};
use crate::output::{self, Console, FORMAT_VERSION, Format};
use crate::terminal::grouped;
use crate::terminal::progress::Progress;
use anyhow::{Context, anyhow};
use clap::Args;
use coinmc::run::RunError;
use coinmc_recording::NewFile;
use coinmc_report::{Run, Samples, report};
use serde_json::json;
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

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
        let page = Page::begin(&self.out, self.force)?;
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
        match failures.len() {
            0 => Ok(runs),
            1 => Err(failures.remove(0)),
            _ => {
                let words: Vec<String> = failures.iter().map(Failure::message).collect();
                Err(Failure::Input(anyhow!("{}", words.join("\n"))))
            }
        }
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

/// A page that appears when it is complete: a new file, or in place of an earlier page.
pub(super) struct Page {
    path: PathBuf,
    file: NewFile,
    replaces: bool,
}

impl Page {
    /// Whether the name is that of a page, and of no file that is not to be replaced, as coinmc did not make it.
    pub(super) fn check(path: &Path) -> Result<(), Failure> {
        if path.exists() && !is_page(path) {
            return Err(Failure::Input(anyhow!(
                "{} is no page of coinmc and is not replaced: choose another name, or move it away",
                path.display()
            )));
        }
        must_end_in(path, "html")
    }

    /// Begins a page. What stands there is replaced only if `replace` and if coinmc made it.
    pub(super) fn begin(path: &Path, replace: bool) -> Result<Self, Failure> {
        let replaces = replace && path.exists();
        if replaces {
            Self::check(path)?;
        }
        must_end_in(path, "html")?;
        let file = if replaces {
            NewFile::begin(&beside(path))?
        } else {
            NewFile::begin(path)?
        };
        Ok(Self {
            path: path.to_owned(),
            file,
            replaces,
        })
    }

    /// Writes the page and gives it its name.
    pub(super) fn write(self, text: &str) -> Result<(), Failure> {
        write_file(self.file, text)?;
        if self.replaces {
            fs::rename(beside(&self.path), &self.path)
                .with_context(|| format!("cannot replace {}", self.path.display()))
                .map_err(Failure::Runtime)?;
        }
        Ok(())
    }
}

/// Where a page is written that is to replace one.
fn beside(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".new");
    path.with_file_name(name)
}

/// Whether a file begins as the pages of coinmc do.
fn is_page(path: &Path) -> bool {
    let mut start = Vec::new();
    let read = fs::File::open(path).and_then(|file| file.take(2000).read_to_end(&mut start));
    let text = String::from_utf8_lossy(&start);
    read.is_ok() && text.starts_with("<!doctype html>") && text.contains("content=\"coinmc ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc::plan::StoppedBy;
    use coinmc::results::{Results, Row};
    use coinmc::run::{Report, Status};

    fn page() -> String {
        let config = "coin.ratio = 1\nengine.analytic.rule = 'arc'";
        let plan = coinmc::config::parse("test", config, &[]).unwrap();
        let row = Row::new(
            &plan,
            0,
            coinmc_core::Tally::default(),
            StoppedBy::ClosedForm,
        );
        let report_of = Report {
            results: Results::new(&plan, vec![row].into()),
            status: Status::Complete,
            reused_chunks: 0,
            tosses: 0,
            tosses_planned: 0,
        };
        report(
            &[Run::in_memory("a", plan, report_of)],
            None,
            &Samples::default(),
        )
        .unwrap()
    }

    #[test]
    fn only_pages_are_replaced_and_only_on_demand() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.html");
        Page::begin(&path, false).unwrap().write(&page()).unwrap();
        assert!(Page::begin(&path, false).is_err());
        Page::begin(&path, true).unwrap().write(&page()).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), page());
        fs::write(&path, "my notes").unwrap();
        assert!(Page::begin(&path, true).is_err());
        assert!(Page::begin(&dir.path().join("a.txt"), false).is_err());
        assert!(Page::check(&dir.path().join("a.txt")).is_err());
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1);
    }
}

//! `coinmc robot export`: tables from the journal.

use super::read;
use crate::exit::{Failure, Outcome};
use crate::output;
use anyhow::{Context, anyhow};
use clap::Args;
use coinmc::results::{write_csv, write_parquet};
use coinmc_robot::export::{results, rows, write_throws_csv, write_throws_parquet};
use coinmc_robot::{make_folder, replace_file};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Write the throws and the results of an experiment as CSV and Parquet
///
/// throws.csv and throws.parquet have one row per throw; results.csv and results.parquet are tables
/// like those of `coinmc run`, so that experiment and simulation fit into one plot. The journal is
/// only read: the experiment can continue meanwhile.
#[derive(Debug, Args)]
pub(super) struct Export {
    /// Directory of the experiment
    #[arg(value_name = "DIR")]
    directory: PathBuf,

    /// Directory for the tables [default: DIR/export, whose tables are replaced]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

impl Export {
    pub(super) fn execute(&self) -> Result<Outcome, Failure> {
        let (experiment, history) = read(&self.directory)?;
        let out = self
            .out
            .clone()
            .unwrap_or_else(|| self.directory.join("export"));
        if self.out.is_some() && out.exists() {
            return Err(Failure::Input(anyhow!(
                "{} exists: give a new directory, or none to replace the tables in {}",
                out.display(),
                self.directory.display()
            )));
        }
        let rows = rows(&experiment, &history).map_err(|error| Failure::Input(error.into()))?;
        let results = results(&experiment, &history);
        let written = make_folder(&out)
            .and_then(|()| write(&out, "throws.csv", |to| write_throws_csv(&rows, to)))
            .and_then(|()| {
                write(&out, "throws.parquet", |to| {
                    write_throws_parquet(&rows, &experiment, to)
                })
            })
            .and_then(|()| write(&out, "results.csv", |to| write_csv(&results, to)))
            .and_then(|()| write(&out, "results.parquet", |to| write_parquet(&results, to)));
        written
            .with_context(|| format!("cannot write the tables in {}", out.display()))
            .map_err(Failure::Runtime)?;
        output::note(&format!(
            "coinmc: {} throws in {}",
            rows.len(),
            out.display()
        ));
        Ok(Outcome::Done)
    }
}

/// Writes a table atomically.
fn write(
    folder: &Path,
    name: &str,
    content: impl FnOnce(&mut (dyn Write + Send)) -> io::Result<()>,
) -> io::Result<()> {
    replace_file(&folder.join(name), content)
}

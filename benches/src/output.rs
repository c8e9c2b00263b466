//! The options that every study has: where its rows go, and its seed.

use crate::report::Report;
use anyhow::{Context, anyhow};
use clap::Args;
use std::fs::File;
use std::io::{self, Write};
use std::path::PathBuf;

/// Where a study's report goes, and the key of its random numbers.
#[derive(Debug, Clone, Args)]
pub struct Output {
    /// Also write every row of the study to this file
    #[arg(long, global = true, value_name = "FILE")]
    csv: Option<PathBuf>,

    /// Key of all random numbers
    #[arg(long, global = true, default_value_t = 1)]
    seed: u64,
}

impl Output {
    /// Executes a study with the seed, prints its report and writes its rows.
    ///
    /// # Errors
    /// If the file cannot be written (found out before the study starts: a typing error must not
    /// cost minutes), or the study fails.
    pub fn report(self, study: impl FnOnce(u64) -> anyhow::Result<Report>) -> anyhow::Result<()> {
        let create = |path: PathBuf| match File::create(&path) {
            Ok(file) => Ok((path, file)),
            Err(error) => Err(anyhow!("cannot write {}: {error}", path.display())),
        };
        let csv = self.csv.map(create).transpose()?;
        let report = study(self.seed)?;
        if let Some((path, file)) = csv {
            let written = report.write_csv(file);
            written.with_context(|| format!("cannot write {}", path.display()))?;
        }
        write!(io::stdout().lock(), "{report}")?;
        Ok(())
    }
}

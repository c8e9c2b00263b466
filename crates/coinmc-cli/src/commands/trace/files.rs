//! Files of traces: the name's ending says what is in them.

use crate::exit::Failure;
use anyhow::anyhow;
use coinmc::plan::Plan;
use coinmc_recording::{Compression, Error, NewFile};
use coinmc_trace::{Trace, svg, write_csv, write_jsonl, write_mcap, write_parquet};
use std::io;
use std::path::{Path, PathBuf};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Mcap,
    Csv,
    Parquet,
    Jsonl,
    Svg,
}

/// New files, begun before anything takes time, in their places only when complete.
pub(super) struct Files {
    files: Vec<(PathBuf, Kind, NewFile)>,
}

impl Files {
    /// Begins files of at most so many traces.
    pub(super) fn begin(paths: &[PathBuf], traces: usize) -> Result<Self, Failure> {
        let mut files: Vec<(PathBuf, Kind, NewFile)> = Vec::new();
        for path in paths {
            let kind = kind(path)?;
            if kind == Kind::Svg && traces > 1 {
                return Err(Failure::Input(anyhow!(
                    "{} would show one toss, and {traces} were asked for: ask for one",
                    path.display()
                )));
            }
            if files.iter().any(|(other, ..)| other == path) {
                return Err(Failure::Input(anyhow!(
                    "{} was named twice",
                    path.display()
                )));
            }
            files.push((path.clone(), kind, NewFile::begin(path)?));
        }
        Ok(Self { files })
    }

    /// Writes all of them; their paths.
    pub(super) fn write(
        self,
        plan: &Plan,
        traces: &[Trace],
        compression: Compression,
    ) -> Result<Vec<PathBuf>, Failure> {
        let mut paths = Vec::new();
        for (path, kind, mut file) in self.files {
            let out = &mut file;
            let written = match kind {
                Kind::Mcap => write_mcap(plan, traces, compression, out),
                Kind::Csv => write_csv(traces, out).map_err(Error::Stream),
                Kind::Parquet => write_parquet(plan, traces, out).map_err(Error::Stream),
                Kind::Jsonl => write_jsonl(plan, traces, out).map_err(Error::Stream),
                Kind::Svg => picture(traces, out).map_err(Error::Stream),
            };
            written.map_err(|error| error.with_path(&path))?;
            file.finish()?;
            paths.push(path);
        }
        Ok(paths)
    }
}

/// `begin` has made sure that it is one at most.
fn picture(traces: &[Trace], out: &mut NewFile) -> io::Result<()> {
    traces
        .iter()
        .try_for_each(|trace| svg::write(trace, &mut *out))
}

fn kind(path: &Path) -> Result<Kind, Failure> {
    let ending = path.extension().and_then(|ending| ending.to_str());
    match ending.map(str::to_ascii_lowercase).as_deref() {
        Some("mcap") => Ok(Kind::Mcap),
        Some("csv") => Ok(Kind::Csv),
        Some("parquet") => Ok(Kind::Parquet),
        Some("jsonl") => Ok(Kind::Jsonl),
        Some("svg") => Ok(Kind::Svg),
        _ => Err(Failure::Input(anyhow!(
            "{} does not say what to write: let it end in .mcap, .csv, .parquet, .jsonl or .svg",
            path.display()
        ))),
    }
}

//! Trace files, whose format is given by the name's extension.

use crate::exit::Failure;
use anyhow::anyhow;
use coinmc::plan::Plan;
use coinmc_recording::{Compression, Encoding, Error, NewFile};
use coinmc_report::MAX_TOSSES;
use coinmc_trace::{Trace, svg, write_csv, write_jsonl, write_mcap, write_parquet};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Mcap,
    Csv,
    Parquet,
    Jsonl,
    Svg,
    Html,
}

/// New files, created before the work begins, which appear only when complete.
pub(super) struct Files {
    files: Vec<(PathBuf, Kind, NewFile)>,
}

impl Files {
    /// Creates files for at most this many traces.
    pub(super) fn begin(paths: &[PathBuf], traces: usize) -> Result<Self, Failure> {
        let mut files: Vec<(PathBuf, Kind, NewFile)> = Vec::new();
        for path in paths {
            let kind = kind(path)?;
            if kind == Kind::Svg && traces > 1 {
                return Err(Failure::Input(anyhow!(
                    "{} can only show one toss, but {traces} were requested: request one",
                    path.display()
                )));
            }
            if kind == Kind::Html && traces > MAX_TOSSES {
                return Err(Failure::Input(anyhow!(
                    "{} shows at most {MAX_TOSSES} tosses at once, but {traces} were requested",
                    path.display()
                )));
            }
            if files.iter().any(|(other, ..)| other == path) {
                return Err(Failure::Input(anyhow!("{} is given twice", path.display())));
            }
            files.push((path.clone(), kind, NewFile::begin(path)?));
        }
        Ok(Self { files })
    }

    /// Writes all files; returns their paths.
    pub(super) fn write(
        self,
        plan: &Plan,
        traces: &[Trace],
        encoding: Encoding,
        compression: Compression,
    ) -> Result<Vec<PathBuf>, Failure> {
        let mut paths = Vec::new();
        for (path, kind, mut file) in self.files {
            let out = &mut file;
            let written = match kind {
                Kind::Mcap => write_mcap(plan, traces, encoding, compression, out),
                Kind::Csv => write_csv(traces, out).map_err(Error::Stream),
                Kind::Parquet => write_parquet(plan, traces, out).map_err(Error::Stream),
                Kind::Jsonl => write_jsonl(plan, traces, out).map_err(Error::Stream),
                Kind::Html => {
                    let page = coinmc_report::tosses(
                        &traces.iter().map(|trace| (plan, trace)).collect::<Vec<_>>(),
                    );
                    out.write_all(page.as_bytes()).map_err(Error::Stream)
                }
                Kind::Svg => picture(traces, out).map_err(Error::Stream),
            };
            written.map_err(|error| error.with_path(&path))?;
            file.finish()?;
            paths.push(path);
        }
        Ok(paths)
    }
}

/// Writes a picture; `begin` has checked that there is at most one trace.
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
        Some("html") => Ok(Kind::Html),
        _ => Err(Failure::Input(anyhow!(
            "{} has no known extension: use .mcap, .csv, .parquet, .jsonl, .svg or .html",
            path.display()
        ))),
    }
}

//! Trace files, whose format is given by the name's extension.

use crate::exit::Failure;
use anyhow::anyhow;
use coinmc::plan::Plan;
use coinmc_recording::{Compression, Encoding, Error, NewFile};
use coinmc_report::MAX_TOSSES;
use coinmc_trace::{FileKind, Trace};
use std::io::Write;
use std::path::{Path, PathBuf};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Trace(FileKind),
    /// A page.
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
            if kind == Kind::Trace(FileKind::Svg) && traces > 1 {
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
            let written = match kind {
                Kind::Trace(kind) => kind.write(plan, traces, encoding, compression, &mut file),
                Kind::Html => {
                    let page = coinmc_report::tosses(
                        &traces.iter().map(|trace| (plan, trace)).collect::<Vec<_>>(),
                    );
                    file.write_all(page.as_bytes()).map_err(Error::Stream)
                }
            };
            written.map_err(|error| error.with_path(&path))?;
            file.finish()?;
            paths.push(path);
        }
        Ok(paths)
    }
}

/// Whether the name of a file is that of an MCAP file.
pub(super) fn is_mcap(path: &Path) -> bool {
    matches!(kind(path), Ok(Kind::Trace(FileKind::Mcap)))
}

fn kind(path: &Path) -> Result<Kind, Failure> {
    let ending = path.extension().and_then(|ending| ending.to_str());
    if ending.is_some_and(|ending| ending.eq_ignore_ascii_case("html")) {
        return Ok(Kind::Html);
    }
    FileKind::of(path).map(Kind::Trace).map_err(|_| {
        Failure::Input(anyhow!(
            "{} has no known extension: use .mcap, .csv, .parquet, .jsonl, .svg or .html",
            path.display()
        ))
    })
}

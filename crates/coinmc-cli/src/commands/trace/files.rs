//! Trace files, whose format is given by the name's extension.

use crate::exit::Failure;
use anyhow::anyhow;
use coinmc::plan::Plan;
use coinmc_recording::{Compression, NewFile};
use coinmc_trace::{FileKind, Trace};
use std::path::PathBuf;

/// New files, created before the work begins, which appear only when complete.
pub(super) struct Files {
    files: Vec<(PathBuf, FileKind, NewFile)>,
}

impl Files {
    /// Creates files for at most this many traces.
    pub(super) fn begin(paths: &[PathBuf], traces: usize) -> Result<Self, Failure> {
        let mut files: Vec<(PathBuf, FileKind, NewFile)> = Vec::new();
        for path in paths {
            let kind = FileKind::of(path).map_err(|error| Failure::Input(error.into()))?;
            if kind == FileKind::Svg && traces > 1 {
                return Err(Failure::Input(anyhow!(
                    "{} can only show one toss, but {traces} were requested: request one",
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
        compression: Compression,
    ) -> Result<Vec<PathBuf>, Failure> {
        let mut paths = Vec::new();
        for (path, kind, mut file) in self.files {
            let written = kind.write(plan, traces, compression, &mut file);
            written.map_err(|error| error.with_path(&path))?;
            file.finish()?;
            paths.push(path);
        }
        Ok(paths)
    }
}

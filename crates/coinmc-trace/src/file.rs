//! Trace files, whose format is given by the extension of their name.

#[cfg(feature = "parquet")]
use crate::write_parquet;
use crate::{Trace, svg, write_csv, write_jsonl, write_mcap};
use coinmc::plan::Plan;
use coinmc_recording::{Compression, Encoding, Error, NewFile};
use std::path::{Path, PathBuf};

/// A format of trace files.
///
/// # Example
/// ```
/// use coinmc_trace::FileKind;
/// use std::path::Path;
/// assert_eq!(FileKind::of(Path::new("toss.MCAP")), Ok(FileKind::Mcap));
/// assert!(FileKind::of(Path::new("toss.png")).is_err());
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FileKind {
    /// A recording for Lichtblick, Foxglove and their like.
    Mcap,
    /// A table.
    Csv,
    /// A table.
    #[cfg(feature = "parquet")]
    Parquet,
    /// One JSON document a line.
    Jsonl,
    /// A picture of one toss.
    Svg,
}

/// A name whose extension says no format.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{} has no known extension: use .mcap, .csv, .parquet, .jsonl or .svg", .0.display())]
pub struct UnknownKind(PathBuf);

impl FileKind {
    /// The format that the extension of a path names.
    ///
    /// # Errors
    /// [`UnknownKind`] if it names none.
    pub fn of(path: &Path) -> Result<Self, UnknownKind> {
        let ending = path.extension().and_then(|ending| ending.to_str());
        match ending.map(str::to_ascii_lowercase).as_deref() {
            Some("mcap") => Ok(Self::Mcap),
            Some("csv") => Ok(Self::Csv),
            #[cfg(feature = "parquet")]
            Some("parquet") => Ok(Self::Parquet),
            Some("jsonl") => Ok(Self::Jsonl),
            Some("svg") => Ok(Self::Svg),
            _ => Err(UnknownKind(path.to_owned())),
        }
    }

    /// Writes traces of a plan to a file of this format. A picture shows the first of them.
    ///
    /// # Errors
    /// Errors of the file.
    pub fn write(
        self,
        plan: &Plan,
        traces: &[Trace],
        encoding: Encoding,
        compression: Compression,
        out: &mut NewFile,
    ) -> Result<(), Error> {
        match self {
            Self::Mcap => write_mcap(plan, traces, encoding, compression, out),
            Self::Csv => write_csv(traces, out).map_err(Error::Stream),
            #[cfg(feature = "parquet")]
            Self::Parquet => write_parquet(plan, traces, out).map_err(Error::Stream),
            Self::Jsonl => write_jsonl(plan, traces, out).map_err(Error::Stream),
            Self::Svg => match traces.first() {
                Some(trace) => svg::write(trace, out).map_err(Error::Stream),
                None => Ok(()),
            },
        }
    }
}

//! Recordings that were cut off or damaged.
//!
//! A file is walked record by record, and nothing in it is believed: every length is checked
//! against the file and against the other lengths of its record, chunks against their checksum.
//! Where that fails, the walk looks on, byte by byte, for the next record that is consistent. What
//! was read is written to a new file, with a new index.

mod copy;
mod shape;
mod source;
mod walk;

use crate::error::Error;
use crate::place::NewFile;
use crate::sink::{Passing, Sink};
use std::fs::File;
use std::io::{Read, Seek};
use std::path::Path;

/// What was recovered, and what was not.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Recovered {
    /// Messages in the new file.
    pub messages: u64,
    /// Channels that they belong to.
    pub channels: usize,
    /// Attachments in the new file.
    pub attachments: u64,
    /// Metadata records in the new file.
    pub metadata: u64,
    /// Bytes of the damaged file that made no sense, or not all of it.
    pub lost_bytes: u64,
    /// Chunks that could not be read, or not to their end.
    pub lost_chunks: u64,
    /// Of these, chunks in a compression that this crate does not know.
    pub unknown_compression: u64,
    /// Messages that were read and could not be kept: of no channel that is known.
    pub lost_messages: u64,
    /// Whether the file had its proper end.
    pub had_end: bool,
}

impl Recovered {
    /// Whether nothing was wrong with the file.
    pub fn was_whole(&self) -> bool {
        self.had_end && self.lost_bytes == 0 && self.lost_messages == 0
    }
}

/// Writes what can be read of a damaged recording to a new file, which appears only when it is
/// complete. The damaged file is only read. Chunks keep their compression.
///
/// Memory: a few times the longest record, and at most a few times 256 MiB; longer records are
/// left out.
///
/// # Errors
/// [`Error::NotMcap`] if the file was never a recording; [`Error::Exists`] if the new file exists;
/// the system's.
///
/// # Example
/// ```
/// use coinmc_recording::{Options, Recorder, recover};
/// # fn main() -> Result<(), coinmc_recording::Error> {
/// # let dir = tempfile::tempdir().unwrap();
/// # let (torn, whole) = (dir.path().join("torn.mcap"), dir.path().join("whole.mcap"));
/// let mut recorder = Recorder::create(&torn, &Options::default())?;
/// recorder.metadata("robot", &[("arm".to_owned(), "2".to_owned())].into())?;
/// recorder.flush()?;
/// drop(recorder);                                     // the power fails
/// let recovered = recover(&torn, &whole)?;
/// assert_eq!((recovered.metadata, recovered.had_end), (1, false));
/// # Ok(())
/// # }
/// ```
pub fn recover(damaged: &Path, to: &Path) -> Result<Recovered, Error> {
    let file = File::open(damaged).map_err(|error| Error::io("open", damaged, error))?;
    let place = NewFile::begin(to)?;
    let (recovered, written) =
        walk::walk(file, Passing(place)).map_err(|failure| match failure {
            walk::Failure::NotMcap => Error::NotMcap {
                path: damaged.to_owned(),
            },
            walk::Failure::Read(error) => Error::io("read", damaged, error),
            walk::Failure::Write(error) => error.at(to),
        })?;
    written.0.finish()?;
    Ok(recovered)
}

/// [`recover()`] from any input to any output.
///
/// # Errors
/// Those of the input and the output, as [`Error::Stream`]; [`Error::NotMcap`] without a name.
pub fn salvage(input: impl Read + Seek, out: impl Sink) -> Result<Recovered, Error> {
    match walk::walk(input, out) {
        Ok((recovered, _)) => Ok(recovered),
        Err(walk::Failure::NotMcap) => Err(Error::NotMcap {
            path: "input".into(),
        }),
        Err(walk::Failure::Read(error)) => Err(Error::Stream(error)),
        Err(walk::Failure::Write(error)) => Err(error),
    }
}

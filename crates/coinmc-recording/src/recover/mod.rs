//! Recovery of truncated and damaged recordings.
//!
//! A file is read record by record, and nothing in it is trusted: every length is checked against
//! the file and against the other lengths in its record, and chunks against their checksum. After a
//! failed check, the next consistent record is searched for byte by byte. Everything readable is
//! written to a new file with a new index.

mod copy;
mod locate;
mod report;
mod source;
mod walk;

use crate::error::Error;
use crate::new_file::NewFile;
use crate::sink::{Sink, Unsynced};
use std::fs::File;
use std::io::{Read, Seek};
use std::path::Path;

pub use report::Recovered;

/// Writes what is readable in a damaged recording to a new file, which appears only when it is
/// complete. The damaged file is only read. Chunks keep their compression.
///
/// Memory: a few times the longest record, at most a few times 256 MiB; longer records are skipped.
///
/// # Errors
/// [`Error::NotMcap`] if the file is not a recording; [`Error::Exists`] if the new file exists;
/// system errors.
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
    let new_file = NewFile::begin(to)?;
    let (recovered, written) =
        walk::walk(file, Unsynced(new_file)).map_err(|failure| match failure {
            walk::Failure::NotMcap => Error::NotMcap {
                path: damaged.to_owned(),
            },
            walk::Failure::Read(error) => Error::io("read", damaged, error),
            walk::Failure::Write(error) => error.with_path(to),
        })?;
    written.0.finish()?;
    Ok(recovered)
}

/// Like [`recover()`], from any input to any output.
///
/// # Errors
/// Errors of the input and the output, as [`Error::Stream`]; [`Error::NotMcap`], for `input`.
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

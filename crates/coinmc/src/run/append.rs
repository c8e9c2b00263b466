//! Files that grow at their end.

use super::{RunError, replace};
use std::fs::OpenOptions;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;

/// Adds bytes to a file, which is created if it is not there: with `durably`, they are on the disk
/// afterwards.
pub(super) fn append(path: &Path, bytes: &[u8], durably: bool) -> Result<(), RunError> {
    let is_new = !replace::is_file(path);
    let file = OpenOptions::new().append(true).create(true).open(path);
    let mut file = file.map_err(|error| RunError::io("open", path, error))?;
    let end = file.metadata();
    let end = end
        .map_err(|error| RunError::io("read", path, error))?
        .len();
    let mut written = file.write_all(bytes);
    if durably {
        written = written.and_then(|()| file.sync_data());
    }
    written.map_err(|error| {
        // half a text would be cut off by the next run; without it others can read on
        let _ = file.set_len(end);
        RunError::io("write", path, error)
    })?;
    if is_new && durably {
        replace::sync_directory(path.parent().unwrap_or(Path::new(".")))?;
    }
    Ok(())
}

/// Whether a file is there, is not empty and does not end with a line feed.
pub(super) fn ends_within_a_line(path: &Path) -> Result<bool, RunError> {
    let failed = |error| RunError::io("read", path, error);
    let mut file = match replace::open_file(path) {
        Ok(file) => file,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(false),
        Err(error) => return Err(failed(error)),
    };
    let mut last = [b'\n'];
    if file.metadata().map_err(failed)?.len() > 0 {
        file.seek(SeekFrom::End(-1)).map_err(failed)?;
        file.read_exact(&mut last).map_err(failed)?;
    }
    Ok(last != [b'\n'])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_ends_within_a_line_if_its_last_byte_is_no_line_feed() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a");
        assert!(!ends_within_a_line(&path).unwrap(), "not there");
        for (text, expected) in [("", false), ("a\n", false), ("a", true), ("a\nb", true)] {
            std::fs::write(&path, text).unwrap();
            assert_eq!(ends_within_a_line(&path).unwrap(), expected, "{text:?}");
        }
        assert!(ends_within_a_line(dir.path()).is_err());
    }
}

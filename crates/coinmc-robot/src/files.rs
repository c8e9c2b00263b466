//! Files in a directory that may come from anywhere: no symbolic link is followed for writing, and
//! nothing but a regular file is opened (a named pipe would wait for its other end for ever).

use rustix::fs::OFlags;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Read, Write};
use std::os::unix::fs::OpenOptionsExt;
use std::path::{Path, PathBuf};

/// Names tried for a temporary file: some may be left over from killed processes.
const ATTEMPTS: u32 = 100;

/// Opens a regular file for reading.
///
/// # Errors
/// System errors, and [`io::ErrorKind::InvalidInput`] for anything else than a file.
pub(crate) fn open_to_read(path: &Path) -> io::Result<File> {
    open(OpenOptions::new().read(true), path, OFlags::NONBLOCK)
}

/// Opens or creates a regular file for appending; a symbolic link is refused.
///
/// # Errors
/// As [`open_to_read`].
pub(crate) fn open_to_append(path: &Path) -> io::Result<File> {
    open(
        OpenOptions::new().create(true).append(true),
        path,
        OFlags::NONBLOCK | OFlags::NOFOLLOW,
    )
}

/// Opens a regular file for reading and writing; a symbolic link is refused.
///
/// # Errors
/// As [`open_to_read`].
pub(crate) fn open_to_change(path: &Path) -> io::Result<File> {
    open(
        OpenOptions::new().read(true).write(true),
        path,
        OFlags::NONBLOCK | OFlags::NOFOLLOW,
    )
}

fn open(options: &mut OpenOptions, path: &Path, flags: OFlags) -> io::Result<File> {
    let file = options
        .custom_flags(flags.bits().cast_signed())
        .open(path)?;
    if file.metadata()?.is_file() {
        Ok(file)
    } else {
        Err(io::Error::new(
            io::ErrorKind::InvalidInput,
            "it is not a regular file",
        ))
    }
}

/// Reads a text of at most `most` bytes from a regular file.
///
/// # Errors
/// As [`open_to_read`]; also if it is longer, or no text.
pub(crate) fn read_text(path: &Path, most: u64) -> io::Result<String> {
    let mut text = String::new();
    open_to_read(path)?
        .take(most + 1)
        .read_to_string(&mut text)?;
    if text.len() as u64 > most {
        return Err(io::ErrorKind::FileTooLarge.into());
    }
    Ok(text)
}

/// Writes a file that appears with all its content, or not at all, and replaces one of its name. What
/// was there is replaced even if it is a symbolic link: the link, not what it leads to.
///
/// # Errors
/// System errors, and those of `content`.
pub fn replace_file(
    path: &Path,
    content: impl FnOnce(&mut (dyn Write + Send)) -> io::Result<()>,
) -> io::Result<()> {
    let (temporary, file) = temporary(path)?;
    let mut file = BufWriter::new(file);
    let written = content(&mut file)
        .and_then(|()| file.flush())
        .and_then(|()| file.get_ref().sync_all())
        .and_then(|()| fs::rename(&temporary, path));
    if written.is_err() {
        // nothing may remain
        let _ = fs::remove_file(&temporary);
    }
    written
}

/// A new file beside `path`.
fn temporary(path: &Path) -> io::Result<(PathBuf, File)> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let process = std::process::id();
    let mut attempt = 0;
    loop {
        let temporary = path.with_file_name(format!("{name}.{process}-{attempt}.tmp"));
        // `create_new` follows no symbolic link
        let opened = OpenOptions::new()
            .write(true)
            .create_new(true)
            .open(&temporary);
        match opened {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists && attempt < ATTEMPTS => {
                attempt += 1;
            }
            opened => return Ok((temporary, opened?)),
        }
    }
}

/// Makes a folder, unless it is there; a symbolic link is refused.
///
/// # Errors
/// System errors, and [`io::ErrorKind::NotADirectory`] for anything else than a folder.
pub fn make_folder(path: &Path) -> io::Result<()> {
    fs::create_dir_all(path)?;
    if fs::symlink_metadata(path)?.is_dir() {
        Ok(())
    } else {
        Err(io::Error::new(
            io::ErrorKind::NotADirectory,
            "it is a symbolic link, which is not followed for writing",
        ))
    }
}

/// Space that this user can still fill on the file system of a path, bytes.
///
/// # Errors
/// System errors.
pub fn free_bytes(path: &Path) -> io::Result<u64> {
    let system = rustix::fs::statvfs(path)?;
    Ok(system.f_bavail.saturating_mul(system.f_frsize))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::os::unix::fs::symlink;

    #[test]
    fn links_are_not_followed_and_pipes_not_waited_for() {
        let dir = tempfile::tempdir().unwrap();
        let at = |name: &str| dir.path().join(name);
        fs::write(at("victim"), "precious").unwrap();
        symlink(at("victim"), at("link")).unwrap();
        assert!(open_to_append(&at("link")).is_err());
        assert!(open_to_change(&at("link")).is_err());
        replace_file(&at("link"), |to| to.write_all(b"new")).unwrap();
        assert_eq!(fs::read(at("victim")).unwrap(), b"precious");
        assert_eq!(fs::read(at("link")).unwrap(), b"new");
        symlink(dir.path(), at("folder")).unwrap();
        assert!(make_folder(&at("folder")).is_err());
        let pipe = rustix::fs::Mode::from_raw_mode(0o600);
        rustix::fs::mkfifoat(rustix::fs::CWD, at("pipe"), pipe).unwrap();
        assert!(open_to_read(&at("pipe")).is_err() && read_text(&at("pipe"), 9).is_err());
        assert!(open_to_append(&at("pipe")).is_err());
        assert!(read_text(&at("victim"), 7).is_err());
        assert_eq!(read_text(&at("victim"), 8).unwrap(), "precious");
    }
}

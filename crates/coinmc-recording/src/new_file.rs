//! Files that appear complete or not at all and never replace another.

use crate::error::Error;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// A new file that appears under its name only once it is completely on disk, and only if no other
/// file has that name. Dropping it before leaves nothing behind.
///
/// # Example
/// ```
/// use coinmc_recording::NewFile;
/// use std::io::Write;
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let dir = tempfile::tempdir()?;
/// # let path = dir.path().join("a.txt");
/// let mut file = NewFile::begin(&path)?;
/// file.write_all(b"content")?;
/// assert!(!path.exists());
/// file.finish()?;
/// assert!(path.exists() && NewFile::begin(&path).is_err());
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct NewFile {
    path: PathBuf,
    temporary: PathBuf,
    file: BufWriter<File>,
    is_finished: bool,
}

/// Names tried for the temporary file: some may be left over from killed processes.
const ATTEMPTS: u32 = 100;

impl NewFile {
    /// Begins a file that will appear at `path`.
    ///
    /// # Errors
    /// [`Error::Exists`] if something exists there; system errors.
    pub fn begin(path: &Path) -> Result<Self, Error> {
        check_free(path)?;
        let mut attempt = 0;
        loop {
            let temporary = temporary(path, attempt);
            // `create_new` does not follow a symbolic link
            let opened = OpenOptions::new()
                .write(true)
                .create_new(true)
                .open(&temporary);
            match opened {
                Ok(file) => {
                    return Ok(Self {
                        path: path.to_owned(),
                        temporary,
                        file: BufWriter::new(file),
                        is_finished: false,
                    });
                }
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
                    attempt += 1;
                    if attempt == ATTEMPTS {
                        return Err(Error::io("create", &temporary, error));
                    }
                }
                // the user knows the final name, not the temporary one
                Err(error) => return Err(Error::io("create", path, error)),
            }
        }
    }

    /// Makes the file durable and gives it its name.
    ///
    /// # Errors
    /// [`Error::Exists`] if a file of that name was created in the meantime; system errors.
    pub fn finish(mut self) -> Result<(), Error> {
        let file = &mut self.file;
        let flushed = file.flush().and_then(|()| file.get_ref().sync_all());
        flushed.map_err(|error| Error::io("write", &self.path, error))?;
        self.move_into_place()?;
        self.is_finished = true;
        sync_directory(&self.path)
    }

    /// Creates a hard link, which atomically fails if the name is taken, then removes the temporary
    /// name. On file systems without hard links the name is checked, then the file renamed.
    fn move_into_place(&self) -> Result<(), Error> {
        let linked = fs::hard_link(&self.temporary, &self.path);
        match linked {
            Ok(()) => fs::remove_file(&self.temporary)
                .map_err(|error| Error::io("remove", &self.temporary, error)),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => Err(Error::Exists {
                path: self.path.clone(),
            }),
            Err(_) => {
                check_free(&self.path)?;
                fs::rename(&self.temporary, &self.path)
                    .map_err(|error| Error::io("move into place", &self.path, error))
            }
        }
    }
}

impl Write for NewFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Drop for NewFile {
    fn drop(&mut self) {
        if !self.is_finished {
            // Errors are ignored: a leftover does no harm, and its name says what it is.
            let _ = fs::remove_file(&self.temporary);
        }
    }
}

fn check_free(path: &Path) -> Result<(), Error> {
    match fs::symlink_metadata(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        Err(error) => Err(Error::io("create", path, error)),
        Ok(_) => Err(Error::Exists {
            path: path.to_owned(),
        }),
    }
}

fn temporary(path: &Path, attempt: u32) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(format!(".{}-{attempt}.tmp", std::process::id()));
    name.into()
}

/// Makes a new name of a file survive a loss of power.
///
/// # Errors
/// [`Error::Io`] if its directory cannot be synced.
///
/// # Example
/// ```
/// let dir = tempfile::tempdir().unwrap();
/// let (old, new) = (dir.path().join("a"), dir.path().join("b"));
/// std::fs::write(&old, "text").unwrap();
/// std::fs::rename(&old, &new).unwrap();
/// coinmc_recording::sync_directory(&new)?;
/// # Ok::<(), coinmc_recording::Error>(())
/// ```
pub fn sync_directory(path: &Path) -> Result<(), Error> {
    // Other systems cannot open a directory like a file, and journal names anyway.
    if cfg!(unix) {
        let parent = match path.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        };
        let synced = File::open(parent).and_then(|directory| directory.sync_all());
        synced.map_err(|error| Error::io("sync", parent, error))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unfinished_file_leaves_nothing_and_a_file_created_meanwhile_is_not_replaced() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a");
        let mut begun = NewFile::begin(&path).unwrap();
        begun.write_all(b"half").unwrap();
        drop(begun);
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0);

        let mut late = NewFile::begin(&path).unwrap();
        late.write_all(b"late").unwrap();
        fs::write(&path, "first").unwrap();
        assert!(matches!(late.finish(), Err(Error::Exists { .. })));
        assert_eq!(fs::read_to_string(&path).unwrap(), "first");
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn a_symbolic_link_is_not_followed() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a");
        std::os::unix::fs::symlink(dir.path().join("nothing"), &path).unwrap();
        assert!(matches!(NewFile::begin(&path), Err(Error::Exists { .. })));
    }
}

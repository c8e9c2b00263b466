//! Files that are there as a whole or not at all, and never in another's place.

use crate::error::Error;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// A new file that takes its place only when all of it is on the disk, and only if nothing else
/// stands there. Dropped before, it leaves nothing.
///
/// # Example
/// ```
/// use coinmc_recording::NewFile;
/// use std::io::Write;
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let dir = tempfile::tempdir()?;
/// # let path = dir.path().join("a.txt");
/// let mut file = NewFile::begin(&path)?;
/// file.write_all(b"all of it")?;
/// assert!(!path.exists());
/// file.finish()?;
/// assert!(path.exists() && NewFile::begin(&path).is_err());
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct NewFile {
    place: PathBuf,
    temporary: PathBuf,
    file: BufWriter<File>,
    /// The file stands in its place.
    is_placed: bool,
}

/// Names tried for the temporary file: others may be a killed process's leftovers.
const ATTEMPTS: u32 = 100;

impl NewFile {
    /// Begins a file that will stand at `place`.
    ///
    /// # Errors
    /// [`Error::Exists`] if something stands there, or the system's.
    pub fn begin(place: &Path) -> Result<Self, Error> {
        must_be_free(place)?;
        let mut attempt = 0;
        loop {
            let temporary = temporary(place, attempt);
            // `create_new` does not follow a link that somebody may have put there
            let opened = OpenOptions::new()
                .write(true)
                .create_new(true)
                .open(&temporary);
            match opened {
                Ok(file) => {
                    return Ok(Self {
                        place: place.to_owned(),
                        temporary,
                        file: BufWriter::new(file),
                        is_placed: false,
                    });
                }
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
                    attempt += 1;
                    if attempt == ATTEMPTS {
                        return Err(Error::io("create", &temporary, error));
                    }
                }
                // the user knows the file by its own name
                Err(error) => return Err(Error::io("create", place, error)),
            }
        }
    }

    /// Puts the file in its place, on the disk to stay.
    ///
    /// # Errors
    /// [`Error::Exists`] if something has come to stand there meanwhile, or the system's.
    pub fn finish(mut self) -> Result<(), Error> {
        let file = &mut self.file;
        let flushed = file.flush().and_then(|()| file.get_ref().sync_all());
        flushed.map_err(|error| Error::io("write", &self.place, error))?;
        self.settle()?;
        self.is_placed = true;
        sync_directory(&self.place)
    }

    /// A link is made only where nothing stands, in one step; then the other name goes. File
    /// systems without links are asked first whether the place is free.
    fn settle(&self) -> Result<(), Error> {
        let linked = fs::hard_link(&self.temporary, &self.place);
        match linked {
            Ok(()) => fs::remove_file(&self.temporary)
                .map_err(|error| Error::io("remove", &self.temporary, error)),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => Err(Error::Exists {
                path: self.place.clone(),
            }),
            Err(_) => {
                must_be_free(&self.place)?;
                fs::rename(&self.temporary, &self.place)
                    .map_err(|error| Error::io("put into place", &self.place, error))
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
        if !self.is_placed {
            // A leftover does no harm: its name says what it is.
            let _ = fs::remove_file(&self.temporary);
        }
    }
}

fn must_be_free(place: &Path) -> Result<(), Error> {
    match fs::symlink_metadata(place) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        Err(error) => Err(Error::io("create", place, error)),
        Ok(_) => Err(Error::Exists {
            path: place.to_owned(),
        }),
    }
}

fn temporary(place: &Path, attempt: u32) -> PathBuf {
    let mut name = place.as_os_str().to_owned();
    name.push(format!(".{}-{attempt}.tmp", std::process::id()));
    name.into()
}

/// Makes the new name last through a loss of power.
fn sync_directory(place: &Path) -> Result<(), Error> {
    // Elsewhere a directory cannot be opened like a file, and names are journalled anyway.
    if cfg!(unix) {
        let parent = match place.parent() {
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
    fn an_unfinished_file_leaves_nothing_and_a_place_taken_meanwhile_is_left_alone() {
        let dir = tempfile::tempdir().unwrap();
        let place = dir.path().join("a");
        let mut begun = NewFile::begin(&place).unwrap();
        begun.write_all(b"half").unwrap();
        drop(begun);
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0);

        let mut late = NewFile::begin(&place).unwrap();
        late.write_all(b"late").unwrap();
        fs::write(&place, "first").unwrap();
        assert!(matches!(late.finish(), Err(Error::Exists { .. })));
        assert_eq!(fs::read_to_string(&place).unwrap(), "first");
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_is_not_written_through() {
        let dir = tempfile::tempdir().unwrap();
        let place = dir.path().join("a");
        std::os::unix::fs::symlink(dir.path().join("nothing"), &place).unwrap();
        assert!(matches!(NewFile::begin(&place), Err(Error::Exists { .. })));
    }
}

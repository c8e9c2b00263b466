//! Atomic files: present with all their content, or absent.

use super::RunError;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Read, Write};
use std::path::{Path, PathBuf};

/// Appended to a file's name while it is being written.
pub(super) const TEMPORARY: &str = ".tmp";

/// A file that gets its final name only when all of its content is on the disk. If it is dropped
/// before, nothing remains.
#[derive(Debug)]
pub(super) struct Replacement {
    place: PathBuf,
    temporary: PathBuf,
    /// `None` once the file has its final name.
    file: Option<BufWriter<File>>,
    /// Nothing was written since the last sync: another sync would wait for the disk in vain.
    synced: bool,
}

impl Replacement {
    /// Begins a file that will be named `place`.
    pub(super) fn begin(place: &Path) -> Result<Self, RunError> {
        let temporary = temporary(place);
        remove(&temporary)?;
        // `create_new` follows no symbolic link
        let file = OpenOptions::new()
            .write(true)
            .create_new(true)
            .open(&temporary);
        let file = file.map_err(|error| RunError::io("create", &temporary, error))?;
        Ok(Self {
            place: place.to_owned(),
            temporary,
            file: Some(BufWriter::new(file)),
            synced: false,
        })
    }

    /// Writes the content.
    pub(super) fn writer(&mut self) -> impl Write + Send + '_ {
        self.synced = false;
        self.file.as_mut().expect("only `finish` takes the file")
    }

    /// The [`RunError`] for an error met while writing the content.
    pub(super) fn error(&self, error: io::Error) -> RunError {
        RunError::io("write", &self.place, error)
    }

    /// Flushes all content to the system.
    pub(super) fn hand_over(&mut self) -> Result<(), RunError> {
        let handed_over = self.writer().flush();
        handed_over.map_err(|error| self.error(error))
    }

    /// Syncs the content to the disk.
    pub(super) fn sync(&mut self) -> Result<(), RunError> {
        if self.synced {
            return Ok(());
        }
        self.hand_over()?;
        let file = self.file.as_ref().expect("only `finish` takes the file");
        let synced = file.get_ref().sync_all();
        synced.map_err(|error| self.error(error))?;
        self.synced = true;
        Ok(())
    }

    /// Syncs the file and gives it its final name, which is durable once the directory is synced
    /// too.
    pub(super) fn finish(mut self) -> Result<(), RunError> {
        self.sync()?;
        fs::rename(&self.temporary, &self.place)
            .map_err(|error| RunError::io("put into place", &self.place, error))?;
        self.file = None;
        Ok(())
    }

    /// Like [`finish`](Self::finish), but keeps an existing file that has the same content. Returns
    /// whether other content was replaced.
    pub(super) fn finish_if_new(mut self) -> Result<bool, RunError> {
        self.sync()?;
        let existed = is_file(&self.place);
        if existed && same_content(&self.temporary, &self.place).map_err(|e| self.error(e))? {
            return Ok(false);
        }
        self.finish()?;
        Ok(existed)
    }
}

impl Drop for Replacement {
    fn drop(&mut self) {
        if self.file.take().is_some() {
            // A remaining temporary file does no harm: the next run in this directory removes it.
            let _ = fs::remove_file(&self.temporary);
        }
    }
}

/// Writes a whole file.
pub(super) fn replace(place: &Path, content: &[u8]) -> Result<(), RunError> {
    let mut file = Replacement::begin(place)?;
    file.writer()
        .write_all(content)
        .map_err(|error| RunError::io("write", place, error))?;
    file.finish()
}

/// Removes a file if it exists.
pub(super) fn remove(path: &Path) -> Result<(), RunError> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => {
            Err(RunError::io("remove", path, error))
        }
        _ => Ok(()),
    }
}

/// Gives a file another name, in place of one that has it.
pub(super) fn rename(from: &Path, to: &Path) -> Result<(), RunError> {
    fs::rename(from, to).map_err(|error| RunError::io("rename", from, error))
}

/// Removes the temporary file that a killed run may have left for `place`.
pub(super) fn remove_leftover(place: &Path) -> Result<(), RunError> {
    remove(&temporary(place))
}

/// Creates a directory, and those above it, that a loss of power does not take away.
pub(super) fn create_directories(path: &Path) -> Result<(), RunError> {
    let is_missing = |path: &&Path| !path.as_os_str().is_empty() && !path.exists();
    let new: Vec<&Path> = path.ancestors().take_while(is_missing).collect();
    fs::create_dir_all(path).map_err(|error| RunError::io("create", path, error))?;
    for parent in new.into_iter().filter_map(Path::parent) {
        let parent = Some(parent).filter(|parent| !parent.as_os_str().is_empty());
        // who may write into a directory need not be allowed to read it
        let _ = sync_directory(parent.unwrap_or(Path::new(".")));
    }
    Ok(())
}

/// Makes renames in a directory survive a loss of power.
pub(super) fn sync_directory(path: &Path) -> Result<(), RunError> {
    // Elsewhere a directory cannot be opened like a file, and renames are journalled anyway.
    if cfg!(unix) {
        let synced = File::open(path).and_then(|directory| directory.sync_all());
        synced.map_err(|error| RunError::io("sync", path, error))?;
    }
    Ok(())
}

/// Whether a regular file, not a link to one, has this path.
pub(super) fn is_file(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok_and(|metadata| metadata.is_file())
}

/// Opens a file to read it. What is none is refused: to open a pipe would wait for somebody to write.
pub(super) fn open_file(path: &Path) -> io::Result<File> {
    if fs::metadata(path)?.is_file() {
        File::open(path)
    } else {
        Err(io::Error::other("this is not a file"))
    }
}

/// Reads a file of at most `most` bytes; `None` if it is longer.
pub(super) fn read_bounded(path: &Path, most: usize) -> io::Result<Option<Vec<u8>>> {
    let mut bytes = Vec::new();
    open_file(path)?
        .take(most as u64 + 1)
        .read_to_end(&mut bytes)?;
    Ok((bytes.len() <= most).then_some(bytes))
}

fn temporary(place: &Path) -> PathBuf {
    let mut name = place.as_os_str().to_owned();
    name.push(TEMPORARY);
    name.into()
}

fn same_content(a: &Path, b: &Path) -> io::Result<bool> {
    let (a, b) = (File::open(a)?, File::open(b)?);
    if a.metadata()?.len() != b.metadata()?.len() {
        return Ok(false);
    }
    let (mut a, mut b) = (io::BufReader::new(a).bytes(), io::BufReader::new(b).bytes());
    loop {
        match (a.next().transpose()?, b.next().transpose()?) {
            (None, None) => return Ok(true),
            (x, y) if x != y => return Ok(false),
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unfinished_file_leaves_nothing_and_a_finished_one_replaces_a_link() {
        let dir = tempfile::tempdir().unwrap();
        let (place, precious) = (dir.path().join("a"), dir.path().join("precious"));
        let mut begun = Replacement::begin(&place).unwrap();
        begun.writer().write_all(b"half").unwrap();
        drop(begun);
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0);

        fs::write(&precious, "kept").unwrap();
        #[cfg(unix)]
        for link in [place.clone(), temporary(&place)] {
            std::os::unix::fs::symlink(&precious, link).unwrap();
        }
        replace(&place, b"new").unwrap();
        assert!(is_file(&place));
        assert_eq!(fs::read(&place).unwrap(), b"new");
        assert_eq!(fs::read(&precious).unwrap(), b"kept");
    }

    #[test]
    fn what_is_not_there_is_removed_and_a_directory_is_not() {
        let dir = tempfile::tempdir().unwrap();
        let place = dir.path().join("a");
        remove(&place).unwrap();
        fs::write(&place, "mine").unwrap();
        remove(&place).unwrap();
        assert!(!place.exists());
        fs::create_dir(&place).unwrap();
        let error = remove(&place).unwrap_err();
        assert!(error.to_string().starts_with("cannot remove"), "{error}");
    }

    #[test]
    fn the_same_content_is_left_alone() {
        let dir = tempfile::tempdir().unwrap();
        let place = dir.path().join("a");
        for (content, replaced) in [("one", false), ("one", false), ("two", true)] {
            let mut file = Replacement::begin(&place).unwrap();
            file.writer().write_all(content.as_bytes()).unwrap();
            assert_eq!(file.finish_if_new().unwrap(), replaced);
            assert_eq!(fs::read_to_string(&place).unwrap(), content);
        }
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_disk_has_its_own_error() {
        let error = File::options()
            .write(true)
            .open("/dev/full")
            .unwrap()
            .write(b"x")
            .unwrap_err();
        let error = RunError::io("write", Path::new("tally"), error);
        assert!(matches!(error, RunError::OutOfSpace { .. }), "{error}");
    }

    #[test]
    fn long_files_are_not_read() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("long");
        fs::write(&path, [0; 11]).unwrap();
        assert_eq!(read_bounded(&path, 10).unwrap(), None);
        assert_eq!(read_bounded(&path, 11).unwrap().unwrap().len(), 11);
    }
}

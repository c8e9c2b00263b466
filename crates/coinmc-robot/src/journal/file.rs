//! The journal's file: locked, append-only, and synced to disk line by line.

use super::text::MAX_LINE;
use super::{Damage, Entry, Header, History, LineChecksum, OrderError, Parsed, Storage, parse};
use crate::files::{open_to_change, open_to_read};
use crate::lock::lock;
use std::fs::{File, OpenOptions};
use std::io::{self, Read, SeekFrom};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Greatest length of a journal, bytes: 4 million throws, three years of a robot's work.
const MAX_BYTES: u64 = 1 << 30;

/// Bytes that are read at once.
const PIECE: u64 = 1 << 16;

/// Most bytes without an end of a line: a torn line, and what a file system may leave after a loss of power.
const MOST_OPEN: usize = 1 << 20;

/// A journal that is locked for appending by this process.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    file: Box<dyn Storage>,
    header: Header,
    history: History,
    checksum: LineChecksum,
    /// Length of the complete lines, bytes.
    whole: u64,
    /// A line could not be written, and its beginning could not be removed.
    broken: bool,
}

/// Why a journal cannot be opened or appended to.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum JournalError {
    /// It is damaged.
    #[error("{} {damage}{}", path.display(), remedy(damage, path))]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        damage: Damage,
    },
    /// It belongs to another experiment.
    #[error(
        "{} is the journal of another experiment (plan {}…, {} throws; this one: plan {}…, {} \
         throws). Give another directory with --out, or the config it was started with",
        path.display(), short(&theirs.plan_hash), theirs.throws, short(&ours.plan_hash), ours.throws
    )]
    OtherExperiment {
        /// The file.
        path: PathBuf,
        /// Its first line.
        theirs: Header,
        /// The first line expected for this experiment.
        ours: Header,
    },
    /// Another process appends to it.
    #[error("{} is in use: another process runs this experiment. Let it finish or end it first", path.display())]
    Locked {
        /// The file.
        path: PathBuf,
    },
    /// It is longer than any experiment could make it.
    #[error("{} has more than {MAX_BYTES} bytes: it is not a journal of a robot", path.display())]
    TooLong {
        /// The file.
        path: PathBuf,
    },
    /// The disk is full. Every throw that was made is in the journal.
    #[error(
        "no space left for {}: {error}. Nothing is lost; free some space and resume",
        path.display()
    )]
    OutOfSpace {
        /// The file.
        path: PathBuf,
        /// The system's error.
        error: io::Error,
    },
    /// Another system error.
    #[error("cannot {action} {}: {error}", path.display())]
    Io {
        /// The failed action.
        action: &'static str,
        /// The file.
        path: PathBuf,
        /// The system's error.
        error: io::Error,
    },
    /// An entry that contradicts the journal: a bug in this program.
    #[error("{} cannot take an entry: {order}", path.display())]
    Order {
        /// The file.
        path: PathBuf,
        /// The contradiction.
        order: OrderError,
    },
}

fn short(hash: &str) -> &str {
    hash.get(..8).unwrap_or(hash)
}

/// The remedy for damage, after what the damage is; that of a newer format says it itself.
fn remedy(damage: &Damage, path: &Path) -> String {
    match damage {
        Damage::Line(line) | Damage::Order { line, .. } if *line > 1 => format!(
            ". Restore a copy of the file from before the damage; or keep a copy of it, truncate it \
             before that line (`head -n {} {}`) and resume with --adopt, which loses the throws after \
             it",
            line - 1,
            path.display()
        ),
        Damage::Newer(_) => String::new(),
        _ => ". Move the directory away or give another one with --out".to_owned(),
    }
}

impl Journal {
    /// Creates a journal in a new file.
    ///
    /// # Errors
    /// [`JournalError`], including if the file exists.
    pub fn create(path: &Path, header: &Header) -> Result<Self, JournalError> {
        let file = OpenOptions::new()
            .read(true)
            .write(true)
            .create_new(true)
            .open(path)
            .map_err(|error| io_error("create", path, error))?;
        lock_journal(&file, path)?;
        let mut journal = Self::new(path, Box::new(file), Parsed::default());
        journal.begin(header)?;
        Ok(journal)
    }

    /// Opens a journal to continue it; also returns the number of bytes of an incomplete last line
    /// that were removed. A journal without a complete first line is started again, because nothing
    /// was thrown yet.
    ///
    /// # Errors
    /// [`JournalError`] if it is damaged, of another experiment, or in use.
    pub fn open(path: &Path, header: &Header) -> Result<(Self, usize), JournalError> {
        let file = open_to_change(path).map_err(|error| io_error("open", path, error))?;
        lock_journal(&file, path)?;
        Self::open_on(Box::new(file), path, header)
    }

    /// As [`Journal::open`], on what is not a file: for tests of what a failing disk does. `path` is its
    /// name in messages.
    ///
    /// # Errors
    /// [`JournalError`], as of [`Journal::open`]; nothing is locked.
    pub fn open_on(
        mut file: Box<dyn Storage>,
        path: &Path,
        header: &Header,
    ) -> Result<(Self, usize), JournalError> {
        let bytes = read_bounded(&mut file, MAX_BYTES, path)?;
        let parsed = match parse(&bytes) {
            Err(Damage::Empty) => {
                let mut journal = Self::new(path, file, Parsed::default());
                journal.truncate()?;
                journal.begin(header)?;
                return Ok((journal, bytes.len()));
            }
            parsed => parsed.map_err(|damage| JournalError::Damaged {
                path: path.to_owned(),
                damage,
            })?,
        };
        if !parsed.header.is_same_plan(header) {
            return Err(JournalError::OtherExperiment {
                path: path.to_owned(),
                theirs: parsed.header,
                ours: header.clone(),
            });
        }
        let torn = parsed.torn;
        let last = last_line(bytes.get(..parsed.whole).unwrap_or_default()).to_vec();
        let mut journal = Self::new(path, file, parsed);
        if torn > 0 {
            journal.truncate()?;
        }
        journal.settle(&last)?;
        Ok((journal, torn))
    }

    /// Reads a journal that another process may be appending to.
    ///
    /// # Errors
    /// [`JournalError`] if it is damaged.
    pub fn read(path: &Path) -> Result<(Header, History), JournalError> {
        let mut file = open_to_read(path).map_err(|error| io_error("open", path, error))?;
        let bytes = read_bounded(&mut file, MAX_BYTES, path)?;
        let parsed = parse(&bytes).map_err(|damage| JournalError::Damaged {
            path: path.to_owned(),
            damage,
        })?;
        Ok((parsed.header, parsed.history))
    }

    /// Whether a process holds the lock of a journal.
    pub fn is_in_use(path: &Path) -> bool {
        open_to_read(path).is_ok_and(|file| lock_journal(&file, path).is_err())
    }

    fn new(path: &Path, file: Box<dyn Storage>, parsed: Parsed) -> Self {
        Self {
            path: path.to_owned(),
            file,
            header: parsed.header,
            history: parsed.history,
            checksum: parsed.checksum,
            whole: parsed.whole as u64,
            broken: false,
        }
    }

    /// Its first line.
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// The throws so far.
    pub fn history(&self) -> &History {
        &self.history
    }

    /// Appends an entry and returns once it is on disk.
    ///
    /// # Errors
    /// [`JournalError`]; the entry is not in the journal then.
    pub fn append(&mut self, entry: &Entry) -> Result<(), JournalError> {
        let (line, checksum) = self.checksum.line(&entry.to_string());
        debug_assert!(line.len() <= MAX_LINE);
        let path = self.path.clone();
        let order = |order| JournalError::Order { path, order };
        if let Err(error) = self.history.check(entry) {
            return Err(order(error));
        }
        self.write(&line, checksum)?;
        self.history.add(entry).map_err(order)
    }

    fn begin(&mut self, header: &Header) -> Result<(), JournalError> {
        let (line, checksum) = LineChecksum::header(header);
        self.write(&line, checksum)?;
        self.header = header.clone();
        sync_folder(&self.path).map_err(|error| io_error("sync", &self.path, error))
    }

    fn write(&mut self, line: &str, checksum: LineChecksum) -> Result<(), JournalError> {
        if self.broken {
            let error = io::Error::other("an incomplete line could not be removed");
            return Err(io_error("append to", &self.path, error));
        }
        let written = self
            .file
            .seek(SeekFrom::Start(self.whole))
            .and_then(|_| self.file.write_all(line.as_bytes()))
            .and_then(|()| self.file.sync());
        if let Err(error) = written {
            // Remove the incomplete line. If that fails, the next process removes it: this one ends
            // anyway.
            self.broken = true;
            let _ = self.file.cut(self.whole);
            return Err(io_error("append to", &self.path, error));
        }
        self.whole += line.len() as u64;
        self.checksum = checksum;
        Ok(())
    }

    /// Writes the last line once more, so that it outlasts a loss of power before anything is done that
    /// depends on it. The process that wrote it may have been killed before its sync; and after a sync
    /// that failed the system shows the line, but does not try to write it again.
    fn settle(&mut self, last: &[u8]) -> Result<(), JournalError> {
        let start = self.whole.saturating_sub(last.len() as u64);
        self.file
            .seek(SeekFrom::Start(start))
            .and_then(|_| self.file.write_all(last))
            .and_then(|()| self.file.sync())
            .and_then(|()| sync_folder(&self.path))
            .map_err(|error| io_error("write again the last line of", &self.path, error))
    }

    /// Removes everything after the complete lines.
    fn truncate(&mut self) -> Result<(), JournalError> {
        self.file
            .cut(self.whole)
            .map_err(|error| io_error("remove the incomplete last line of", &self.path, error))
    }
}

/// On network file systems without locks, the lock on the robot's port protects the experiment.
fn lock_journal(file: &File, path: &Path) -> Result<(), JournalError> {
    lock(file).map_err(|error| match error.kind() {
        io::ErrorKind::WouldBlock => JournalError::Locked {
            path: path.to_owned(),
        },
        _ => io_error("lock", path, error),
    })
}

/// All bytes, if they are no more than `most`. Of a line that is far too long for a journal only its beginning is read,
/// and ended there, so that [`parse`] finds it damaged: such a file could fill the memory.
fn read_bounded(file: &mut impl Read, most: u64, path: &Path) -> Result<Vec<u8>, JournalError> {
    let mut bytes = Vec::new();
    // bytes since the last end of a line
    let mut open = 0;
    loop {
        let before = bytes.len();
        file.by_ref()
            .take(PIECE)
            .read_to_end(&mut bytes)
            .map_err(|error| io_error("read", path, error))?;
        if bytes.len() as u64 > most {
            return Err(JournalError::TooLong {
                path: path.to_owned(),
            });
        }
        let piece = bytes.get(before..).unwrap_or_default();
        if piece.is_empty() {
            return Ok(bytes);
        }
        open = match piece.iter().rposition(|byte| *byte == b'\n') {
            Some(end) => piece.len() - end - 1,
            None => open + piece.len(),
        };
        if open > MOST_OPEN {
            bytes.push(b'\n');
            return Ok(bytes);
        }
    }
}

/// The last of complete lines, with its end.
fn last_line(whole: &[u8]) -> &[u8] {
    let inner = whole.strip_suffix(b"\n").unwrap_or(whole);
    let start = inner.iter().rposition(|byte| *byte == b'\n');
    whole
        .get(start.map_or(0, |at| at + 1)..)
        .unwrap_or_default()
}

fn sync_folder(path: &Path) -> io::Result<()> {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty());
    File::open(folder.unwrap_or(Path::new(".")))?.sync_all()
}

fn io_error(action: &'static str, path: &Path, error: io::Error) -> JournalError {
    use io::ErrorKind::{FileTooLarge, QuotaExceeded, StorageFull};
    let path = path.to_owned();
    match error.kind() {
        StorageFull | QuotaExceeded | FileTooLarge => JournalError::OutOfSpace { path, error },
        _ => JournalError::Io {
            action,
            path,
            error,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_more_is_read_than_a_journal_can_have() {
        let read = |bytes: &[u8]| read_bounded(&mut &*bytes, 3, Path::new("journal.txt"));
        assert_eq!(read(b"").unwrap(), b"");
        assert_eq!(read(b"123").unwrap(), b"123");
        assert!(matches!(read(b"1234"), Err(JournalError::TooLong { .. })));
        // even if there is no end
        let endless = read_bounded(&mut io::repeat(0), 3, Path::new("/dev/zero"));
        assert!(matches!(endless, Err(JournalError::TooLong { .. })));
    }

    /// Of a sparse file of gigabytes no more than a megabyte is read, and it is damaged where its line is too long.
    #[test]
    fn a_line_without_an_end_is_not_read_to_its_end() {
        let zeros = |before: &'static [u8]| {
            let mut file = before.chain(io::repeat(0));
            let bytes = read_bounded(&mut file, MAX_BYTES, Path::new("journal.txt")).unwrap();
            assert!(bytes.len() < MOST_OPEN + 2 * (1 << 16), "{}", bytes.len());
            parse(&bytes).unwrap_err()
        };
        assert_eq!(zeros(b""), Damage::NotAJournal);
        let (header, _) = LineChecksum::header(&Header {
            plan_hash: "abc".to_owned(),
            throws: 3,
            experiment: 1,
        });
        assert_eq!(zeros(header.leak().as_bytes()), Damage::Line(2));
    }

    #[test]
    fn the_last_line_has_its_end_and_nothing_of_the_line_before() {
        assert_eq!(last_line(b"one\ntwo\n"), b"two\n");
        assert_eq!(last_line(b"one\n"), b"one\n");
        assert_eq!(last_line(b""), b"");
    }
}

//! The journal's file: locked, appended to, brought to the disk line by line.

use super::text::LONGEST;
use super::{Damage, Entry, Header, History, Order, Parsed, Seal, parse};
use crate::lock::lock;
use std::fs::{File, OpenOptions};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Longest journal read: 4 million throws, three years of a robot's work.
const MAX_BYTES: u64 = 1 << 30;

/// A journal that this process alone appends to.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    file: File,
    history: History,
    seal: Seal,
    /// Length of the whole lines.
    whole: u64,
    /// A line could not be written, and what there is of it could not be taken back.
    broken: bool,
}

/// Why a journal cannot be opened or appended to.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum JournalError {
    /// It cannot be believed.
    #[error("{} {damage}. {}", path.display(), remedy(damage, path))]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        damage: Damage,
    },
    /// It belongs to another experiment.
    #[error(
        "{} is the journal of another experiment (plan {}…, {} throws; this one: plan {}…, {} \
         throws). Give another directory with --out, or the config it was begun with",
        path.display(), short(&theirs.plan_hash), theirs.throws, short(&ours.plan_hash), ours.throws
    )]
    OtherExperiment {
        /// The file.
        path: PathBuf,
        /// What its first line says.
        theirs: Header,
        /// What was asked for.
        ours: Header,
    },
    /// Another process appends to it.
    #[error("{} is in use: another process runs this experiment. Let it, or end it first", path.display())]
    Locked {
        /// The file.
        path: PathBuf,
    },
    /// It is longer than any robot could make it.
    #[error("{} has more than {MAX_BYTES} bytes: this is no journal of a robot", path.display())]
    TooLong {
        /// The file.
        path: PathBuf,
    },
    /// The disk is full. Nothing was thrown that is not in the journal.
    #[error(
        "no room for {}: {error}. Nothing is lost; make room and resume",
        path.display()
    )]
    OutOfSpace {
        /// The file.
        path: PathBuf,
        /// What the system said.
        error: io::Error,
    },
    /// Another failure of the system.
    #[error("cannot {action} {}: {error}", path.display())]
    Io {
        /// What was tried.
        action: &'static str,
        /// The file.
        path: PathBuf,
        /// What the system said.
        error: io::Error,
    },
    /// An entry that contradicts the journal: a fault of this program.
    #[error("{} cannot take an entry: {order}", path.display())]
    Order {
        /// The file.
        path: PathBuf,
        /// Why.
        order: Order,
    },
}

fn short(hash: &str) -> &str {
    hash.get(..8).unwrap_or(hash)
}

/// What to do about damage.
fn remedy(damage: &Damage, path: &Path) -> String {
    match damage {
        Damage::Line(line) | Damage::Order { line, .. } if *line > 1 => format!(
            "Bring back a copy of the file from before the damage; or keep a copy of it, cut it \
             before that line (`head -n {} {}`), and resume with --adopt: the throws behind are \
             lost then",
            line - 1,
            path.display()
        ),
        Damage::Newer(_) => String::new(),
        _ => "Move the directory away, or give another one with --out".to_owned(),
    }
}

impl Journal {
    /// Begins a journal in a new file.
    ///
    /// # Errors
    /// [`JournalError`], also if the file exists.
    pub fn create(path: &Path, header: &Header) -> Result<Self, JournalError> {
        let file = OpenOptions::new()
            .read(true)
            .write(true)
            .create_new(true)
            .open(path)
            .map_err(|error| io_error("create", path, error))?;
        lock_alone(&file, path)?;
        let mut journal = Self::new(path, file, Parsed::default());
        journal.begin(header)?;
        Ok(journal)
    }

    /// Opens a journal to go on with it, and says how many bytes of a torn last line were cut off.
    /// One without a whole first line is begun anew: nothing was thrown yet.
    ///
    /// # Errors
    /// [`JournalError`] if it is damaged, of another experiment, or in use.
    pub fn open(path: &Path, header: &Header) -> Result<(Self, usize), JournalError> {
        let mut file = OpenOptions::new()
            .read(true)
            .write(true)
            .open(path)
            .map_err(|error| io_error("open", path, error))?;
        lock_alone(&file, path)?;
        let bytes = read_bounded(&mut file, path)?;
        let parsed = match parse(&bytes) {
            Err(Damage::Empty) => {
                let mut journal = Self::new(path, file, Parsed::default());
                journal.cut()?;
                journal.begin(header)?;
                return Ok((journal, bytes.len()));
            }
            parsed => parsed.map_err(|damage| JournalError::Damaged {
                path: path.to_owned(),
                damage,
            })?,
        };
        if parsed.header != *header {
            return Err(JournalError::OtherExperiment {
                path: path.to_owned(),
                theirs: parsed.header,
                ours: header.clone(),
            });
        }
        let torn = parsed.torn;
        let mut journal = Self::new(path, file, parsed);
        if torn > 0 {
            journal.cut()?;
        }
        Ok((journal, torn))
    }

    /// Reads a journal that somebody else may be appending to.
    ///
    /// # Errors
    /// [`JournalError`] if it is damaged.
    pub fn read(path: &Path) -> Result<(Header, History), JournalError> {
        let mut file = File::open(path).map_err(|error| io_error("open", path, error))?;
        let bytes = read_bounded(&mut file, path)?;
        let parsed = parse(&bytes).map_err(|damage| JournalError::Damaged {
            path: path.to_owned(),
            damage,
        })?;
        Ok((parsed.header, parsed.history))
    }

    fn new(path: &Path, file: File, parsed: Parsed) -> Self {
        Self {
            path: path.to_owned(),
            file,
            history: parsed.history,
            seal: parsed.seal,
            whole: parsed.whole as u64,
            broken: false,
        }
    }

    /// All that it says.
    pub fn history(&self) -> &History {
        &self.history
    }

    /// Appends an entry and returns when it is on the disk.
    ///
    /// # Errors
    /// [`JournalError`]; the entry is then not in the journal.
    pub fn append(&mut self, entry: &Entry) -> Result<(), JournalError> {
        let (line, seal) = self.seal.line(&entry.to_string());
        debug_assert!(line.len() <= LONGEST);
        let path = self.path.clone();
        let order = |order| JournalError::Order { path, order };
        if let Err(error) = self.history.check(entry) {
            return Err(order(error));
        }
        self.write(&line, seal)?;
        self.history.add(entry).map_err(order)
    }

    fn begin(&mut self, header: &Header) -> Result<(), JournalError> {
        let (line, seal) = Seal::header(header);
        self.write(&line, seal)?;
        sync_folder(&self.path).map_err(|error| io_error("sync", &self.path, error))
    }

    fn write(&mut self, line: &str, seal: Seal) -> Result<(), JournalError> {
        if self.broken {
            let error = io::Error::other("an earlier line could not be taken back");
            return Err(io_error("append to", &self.path, error));
        }
        let written = self
            .file
            .seek(SeekFrom::Start(self.whole))
            .and_then(|_| self.file.write_all(line.as_bytes()))
            .and_then(|()| self.file.sync_data());
        if let Err(error) = written {
            // What is there of the line must not be taken for one; the process ends anyway, and
            // where the cut fails the next one makes it.
            self.broken = true;
            let _ = self.file.set_len(self.whole);
            return Err(io_error("append to", &self.path, error));
        }
        self.whole += line.len() as u64;
        self.seal = seal;
        Ok(())
    }

    /// Takes off all that stands behind the whole lines.
    fn cut(&mut self) -> Result<(), JournalError> {
        self.file
            .set_len(self.whole)
            .and_then(|()| self.file.sync_all())
            .map_err(|error| io_error("cut the torn last line off", &self.path, error))
    }
}

/// The robot's port is locked as well, where a network file system knows no locks.
fn lock_alone(file: &File, path: &Path) -> Result<(), JournalError> {
    lock(file).map_err(|error| match error.kind() {
        io::ErrorKind::WouldBlock => JournalError::Locked {
            path: path.to_owned(),
        },
        _ => io_error("lock", path, error),
    })
}

fn read_bounded(file: &mut File, path: &Path) -> Result<Vec<u8>, JournalError> {
    let mut bytes = Vec::new();
    file.take(MAX_BYTES + 1)
        .read_to_end(&mut bytes)
        .map_err(|error| io_error("read", path, error))?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(JournalError::TooLong {
            path: path.to_owned(),
        });
    }
    Ok(bytes)
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

//! Why a recording cannot be written or recovered.

use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// What can go wrong.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
    /// The place of a new file is taken.
    #[error("{} exists already: choose another name, or move it away", path.display())]
    Exists {
        /// The file.
        path: PathBuf,
    },
    /// The disk, or the user's share of it, is full.
    #[error("no space left for {}: free some and try again ({source})", path.display())]
    OutOfSpace {
        /// What was being written.
        path: PathBuf,
        /// The system's words.
        source: io::Error,
    },
    /// The system refused to read or write something.
    #[error("cannot {action} {}: {source}", path.display())]
    Io {
        /// What was tried, as a verb.
        action: &'static str,
        /// On what.
        path: PathBuf,
        /// The system's words.
        source: io::Error,
    },
    /// Writing to a stream failed.
    #[error("cannot write the recording: {0}")]
    Stream(#[from] io::Error),
    /// A message cannot be told as JSON.
    #[error("a message for {topic} cannot be written as JSON: {source}")]
    Message {
        /// The channel's topic.
        topic: String,
        /// What serde says.
        source: serde_json::Error,
    },
    /// A piece is longer than the format, or this crate, allows.
    #[error("{what} is too long for a recording: at most {most} bytes")]
    TooLong {
        /// What is too long.
        what: &'static str,
        /// How long it may be.
        most: u64,
    },
    /// The format has no room for more channels or schemas.
    #[error("a recording has at most 65535 {what}")]
    TooMany {
        /// Of what.
        what: &'static str,
    },
    /// An earlier write failed, and what follows would not be readable.
    #[error("the recording is broken since an earlier write failed")]
    Broken,
    /// The file to recover is no recording at all.
    #[error("{} does not begin like an MCAP file: nothing can be recovered", path.display())]
    NotMcap {
        /// The file.
        path: PathBuf,
    },
}

impl Error {
    /// Sorts a system's error: an existing file and a full disk are told apart from all others.
    pub(crate) fn io(action: &'static str, path: &Path, source: io::Error) -> Self {
        use io::ErrorKind::{AlreadyExists, FileTooLarge, QuotaExceeded, StorageFull};
        let path = path.to_owned();
        match source.kind() {
            AlreadyExists => Self::Exists { path },
            StorageFull | QuotaExceeded | FileTooLarge => Self::OutOfSpace { path, source },
            _ => Self::Io {
                action,
                path,
                source,
            },
        }
    }

    /// Names the file that a stream's error is about.
    pub fn at(self, path: &Path) -> Self {
        match self {
            Self::Stream(source) => Self::io("write", path, source),
            other => other,
        }
    }
}

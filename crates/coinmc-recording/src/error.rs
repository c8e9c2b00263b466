//! Why a recording cannot be written or recovered.

use crate::protobuf::SchemaError;
use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Errors of writing and recovering recordings.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
    /// A file of this name exists already.
    #[error("{} exists already: choose another name, or move it away", path.display())]
    Exists {
        /// The file.
        path: PathBuf,
    },
    /// The disk or the user's quota is full.
    #[error("no space left for {}: free some space and try again ({source})", path.display())]
    OutOfSpace {
        /// The file that was being written.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// The system failed to read or write something.
    #[error("cannot {action} {}: {source}", path.display())]
    Io {
        /// What was tried, as a verb.
        action: &'static str,
        /// The file or directory.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// Writing to a stream failed.
    #[error("cannot write the recording: {0}")]
    Stream(#[from] io::Error),
    /// A message cannot be serialised.
    #[error("a message for {topic} cannot be serialised: {source}")]
    Message {
        /// The channel's topic.
        topic: String,
        /// Serde's error.
        source: serde_json::Error,
    },
    /// A message, or the schema of a channel, is not what it should be.
    #[error("a message for {topic} cannot be written as Protobuf: {source}")]
    Schema {
        /// The channel's topic.
        topic: String,
        /// What is wrong.
        source: SchemaError,
    },
    /// A record is longer than the format or this crate allows.
    #[error("{what} is too long for a recording: at most {limit} bytes")]
    TooLong {
        /// What is too long.
        what: &'static str,
        /// The greatest length, bytes.
        limit: u64,
    },
    /// The format has no ids left for another channel or schema.
    #[error("a recording has at most 65535 {what}")]
    TooMany {
        /// Channels or schemas.
        what: &'static str,
    },
    /// An earlier write failed, so that anything written after it would not be readable.
    #[error("the recording is broken: an earlier write failed")]
    Broken,
    /// The file to recover is not an MCAP file.
    #[error("{} is not an MCAP file: nothing can be recovered", path.display())]
    NotMcap {
        /// The file.
        path: PathBuf,
    },
}

impl Error {
    /// Classifies a system error: an existing file and a full disk have variants of their own.
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

    /// Adds the path to an error of the output stream.
    pub fn with_path(self, path: &Path) -> Self {
        match self {
            Self::Stream(source) => Self::io("write", path, source),
            other => other,
        }
    }
}

//! Why a run stopped, and what to do about it.

use super::{Chunk, Missing, Part};
use coinmc_core::EngineError;
use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Why a run, a chunk or a merge failed. Finished chunks are kept whatever the error: the same
/// run can be started again once the cause is gone.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RunError {
    /// The disk or the user's quota is full.
    #[error(
        "no space left for {}: free some and run again, finished chunks are kept ({source})",
        path.display()
    )]
    OutOfSpace {
        /// What was being written.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// Reading or writing failed.
    #[error("cannot {action} {}: {source}", path.display())]
    Io {
        /// The failed operation, as a verb.
        action: &'static str,
        /// The file or directory.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// The directory exists and holds something else.
    #[error(
        "{} is not a run directory: it holds {found}. Choose a new or empty directory",
        dir.display()
    )]
    NotARunDirectory {
        /// The directory.
        dir: PathBuf,
        /// What was found in it.
        found: String,
    },
    /// A directory that is to be read holds no run.
    #[error(
        "{} is not a run directory: {why}. Name the directory of `coinmc run`: its --out, or runs/NAME-HASH",
        dir.display()
    )]
    NoRun {
        /// The directory.
        dir: PathBuf,
        /// Why it is none.
        why: String,
    },
    /// The directory holds a run of another plan, and this one does not go on where it ended.
    #[error(
        "{} holds the run of another plan ({}). Choose another directory, or run the config.toml found there",
        dir.display(),
        why.clone().unwrap_or_else(|| format!("{theirs}; this one is {ours}"))
    )]
    OtherPlan {
        /// The directory.
        dir: PathBuf,
        /// Hash of the plan of the run in it.
        theirs: String,
        /// Hash of the plan to be run.
        ours: String,
        /// What differs, where the other config can be read.
        why: Option<String>,
    },
    /// The config in a run directory is no longer that of its run.
    #[error(
        "{} is not the config that was run: it has been changed since. Undo the change, or run it into a new directory",
        path.display()
    )]
    ChangedConfig {
        /// The config.
        path: PathBuf,
    },
    /// The directory was begun by another version of the program, which may toss differently.
    #[error(
        "{} was begun by coinmc {theirs}, this is {ours}: finish it with {theirs}, or choose \
         another directory",
        dir.display()
    )]
    OtherVersion {
        /// The directory.
        dir: PathBuf,
        /// Version that began it.
        theirs: String,
        /// This program's version.
        ours: String,
    },
    /// The directory holds another part of the same run.
    #[error(
        "{} holds part {theirs} of this run, not part {ours}: give each part its own directory \
         and merge them",
        dir.display()
    )]
    OtherPart {
        /// The directory.
        dir: PathBuf,
        /// The part it holds.
        theirs: Part,
        /// The part to be run.
        ours: Part,
    },
    /// A file has a format that only a newer program can read.
    #[error(
        "{} has format {found}, this program knows up to {known}: use a newer coinmc",
        path.display()
    )]
    NewerFormat {
        /// The file.
        path: PathBuf,
        /// Its format.
        found: u64,
        /// The newest format that this program can read.
        known: u64,
    },
    /// A file has a format of an older program that this one does not read.
    #[error(
        "{} has format {found}, this program reads {known}: finish or read it with the coinmc that \
         began it, or choose another directory",
        path.display()
    )]
    OlderFormat {
        /// The file.
        path: PathBuf,
        /// Its format.
        found: u64,
        /// The format that this program reads.
        known: u64,
    },
    /// The manifest cannot be read.
    #[error(
        "{} is damaged ({reason}): restore it, or move the directory away and run again",
        path.display()
    )]
    BadManifest {
        /// The manifest.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// Another process runs in the directory.
    #[error("another process is running in {}: wait for it, or stop it", dir.display())]
    Locked {
        /// The directory.
        dir: PathBuf,
    },
    /// A run that stops at targets chooses after each look which points to continue; parts on
    /// different machines cannot do that.
    #[error("a run that stops at targets cannot be cut into parts: give a fixed number of tosses")]
    PartsNeedFixedTosses,
    /// The chunk is outside the plan.
    #[error("{chunk} lies outside the plan, which has {points} points")]
    NoSuchChunk {
        /// The chunk asked for.
        chunk: Chunk,
        /// Number of points.
        points: usize,
    },
    /// An engine rejects its settings.
    #[error("point {point}: {source}")]
    Settings {
        /// Index of the point.
        point: usize,
        /// Error of the engine.
        source: EngineError,
    },
    /// No thread could be started.
    #[error("cannot start a thread: {0}")]
    Thread(io::Error),
    /// A merge was given no directory.
    #[error("nothing to merge: name the run directories of the parts")]
    NothingToMerge,
    /// The config in a run directory is invalid.
    #[error("{} does not hold a config that can be read: {reason}", path.display())]
    BadConfig {
        /// The config.
        path: PathBuf,
        /// The first problem found.
        reason: String,
    },
    /// The merged directory would be one of the parts.
    #[error("{} is both a part and the place of the merged run: choose another", dir.display())]
    MergeIntoPart {
        /// The directory.
        dir: PathBuf,
    },
    /// Several directories cannot be used, each for a reason of its own.
    #[error("{}", .0.iter().map(Self::to_string).collect::<Vec<_>>().join("\n"))]
    Several(Vec<Self>),
    /// Some chunks are in none of the parts.
    #[error("{0}")]
    Missing(Missing),
    /// The result of a chunk that another process computed cannot be used.
    #[error("the result of a chunk cannot be used: {reason}")]
    BadResult {
        /// What is wrong with it.
        reason: String,
    },
    /// Two parts count the same tosses differently.
    #[error(
        "{} and {} disagree about {chunk}: one of them is not of this program, or was altered",
        first.display(), second.display()
    )]
    Conflict {
        /// The tosses in question.
        chunk: Chunk,
        /// One run directory.
        first: PathBuf,
        /// The other.
        second: PathBuf,
    },
}

impl RunError {
    /// All of several errors; that itself if there is but one.
    pub(crate) fn all(mut errors: Vec<Self>) -> Self {
        if errors.len() == 1 {
            errors.remove(0)
        } else {
            Self::Several(errors)
        }
    }

    /// Classifies an error of the operating system: a full disk has its own variant.
    pub(crate) fn io(action: &'static str, path: &Path, source: io::Error) -> Self {
        use io::ErrorKind::{FileTooLarge, QuotaExceeded, StorageFull};
        let path = path.to_owned();
        match source.kind() {
            StorageFull | QuotaExceeded | FileTooLarge => Self::OutOfSpace { path, source },
            _ => Self::Io {
                action,
                path,
                source,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_error_is_told_as_itself_and_several_line_by_line() {
        let one = || RunError::NothingToMerge;
        assert!(matches!(
            RunError::all(vec![one()]),
            RunError::NothingToMerge
        ));
        let two = RunError::all(vec![one(), RunError::PartsNeedFixedTosses]);
        assert!(matches!(&two, RunError::Several(all) if all.len() == 2));
        assert_eq!(two.to_string().lines().count(), 2);
    }
}

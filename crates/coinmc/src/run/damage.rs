//! What can be wrong with the file of a finished chunk.

use thiserror::Error;

/// Why the file of a finished chunk is rejected.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub(super) enum Damage {
    #[error("it is not a regular file")]
    NotAFile,
    #[error("it is longer than any tally file")]
    TooLong,
    #[error("its checksum does not match")]
    Checksum,
    #[error("it is of another version of the format")]
    Version,
    #[error("it belongs to another plan")]
    OtherPlan,
    #[error("it holds another chunk than its name says")]
    OtherChunk,
    #[error("the plan has no chunk of that name")]
    NoSuchChunk,
    #[error("its counts are impossible")]
    Counts,
    #[error("it is not in the form that this program writes")]
    Form,
}

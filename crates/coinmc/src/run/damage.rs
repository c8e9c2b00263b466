//! What can be wrong with the tally of a finished chunk.

use thiserror::Error;

/// Why the tally of a finished chunk is rejected.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub(super) enum Damage {
    #[error("it is longer than any tally")]
    TooLong,
    #[error("its checksum does not match")]
    Checksum,
    #[error("it is of another version of the format")]
    Version,
    #[error("it belongs to another plan")]
    OtherPlan,
    #[error("it holds another chunk than the plan has there")]
    OtherChunk,
    #[error("the plan has no such chunk")]
    NoSuchChunk,
    #[error("its counts are impossible")]
    Counts,
    #[error("it is not in the form that this program writes")]
    Form,
}

//! A chunk that was computed, or begun.

use super::Chunk;
use super::chunk_result::{ChunkResult, Tossed};
use super::provenance::{Effort, Entry};

/// A chunk, its result, and the time that it took.
#[derive(Debug, Clone)]
pub(super) struct Made {
    pub(super) chunk: Chunk,
    pub(super) result: ChunkResult,
    pub(super) effort: Effort,
}

/// What a worker has done.
#[derive(Debug, Clone)]
pub(super) enum Work {
    /// A chunk is finished.
    Finished(Made),
    /// So much of a chunk is counted, from its first toss on.
    Begun(Chunk, Tossed),
}

impl Made {
    /// For the record of who made it.
    pub(super) fn entry(&self) -> Entry {
        Entry::new(&self.chunk, self.effort)
    }
}

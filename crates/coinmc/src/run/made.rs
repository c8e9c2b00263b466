//! A chunk that was computed.

use super::Chunk;
use super::chunk_result::ChunkResult;
use super::provenance::{Effort, Entry};

/// A chunk, its result, and the time that it took.
#[derive(Debug, Clone)]
pub(super) struct Made {
    pub(super) chunk: Chunk,
    pub(super) result: ChunkResult,
    pub(super) effort: Effort,
}

impl Made {
    /// For the record of who made it.
    pub(super) fn entry(&self) -> Entry {
        Entry::new(&self.chunk, self.effort)
    }
}

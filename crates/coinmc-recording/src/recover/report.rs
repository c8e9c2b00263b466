//! The report of a recovery.

/// What was recovered and what was lost.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Recovered {
    /// Messages in the new file.
    pub messages: u64,
    /// Channels of these messages.
    pub channels: usize,
    /// Attachments in the new file.
    pub attachments: u64,
    /// Metadata records in the new file.
    pub metadata: u64,
    /// Bytes of the damaged file in records that were not or not completely readable.
    pub lost_bytes: u64,
    /// Chunks that were not or not completely readable.
    pub lost_chunks: u64,
    /// Those of the lost chunks whose compression is not supported.
    pub unknown_compression: u64,
    /// Readable messages that were lost: their channel is unknown, or they are too long.
    pub lost_messages: u64,
    /// Whether the file was finished, with its end intact.
    pub had_end: bool,
}

impl Recovered {
    /// Whether nothing was wrong with the file.
    pub fn was_whole(&self) -> bool {
        self.had_end && self.lost_bytes == 0 && self.lost_messages == 0
    }
}

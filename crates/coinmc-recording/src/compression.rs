//! Compression of chunks.

use lz4_flex::frame::{BlockMode, BlockSize, FrameDecoder, FrameEncoder, FrameInfo};
use std::fmt;
use std::io::{Read, Write};
use std::str::FromStr;

/// How chunks are compressed.
///
/// # Example
/// ```
/// use coinmc_recording::Compression;
/// assert_eq!("lz4".parse(), Ok(Compression::Lz4));
/// assert!("rar".parse::<Compression>().is_err());
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Compression {
    /// Not at all: any tool reads the messages.
    #[default]
    None,
    /// LZ4 frames, which every MCAP reader knows: JSON full of numbers shrinks to less than half.
    Lz4,
}

/// A name that is no compression's.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("compression is `none` or `lz4`")]
pub struct UnknownCompression;

impl Compression {
    /// The name in the file.
    pub(crate) fn in_file(self) -> &'static str {
        match self {
            Self::None => "",
            Self::Lz4 => "lz4",
        }
    }

    /// Of a name in a file.
    pub(crate) fn of_file(name: &str) -> Option<Self> {
        [Self::None, Self::Lz4]
            .into_iter()
            .find(|compression| compression.in_file() == name)
    }

    /// Appends `records`, compressed, to `out`.
    pub(crate) fn compress(self, records: &[u8], out: &mut Vec<u8>) {
        match self {
            Self::None => out.extend_from_slice(records),
            Self::Lz4 => {
                let frame = FrameInfo::new()
                    .block_mode(BlockMode::Linked)
                    .block_size(BlockSize::Max256KB);
                let mut encoder = FrameEncoder::with_frame_info(frame, out);
                // the only error is the sink's, and a vector takes all
                let _ = encoder.write_all(records);
                let _ = encoder.finish();
            }
        }
    }

    /// What `bytes` held before they were compressed, or as much of it as can be read: at most
    /// `most` bytes.
    pub(crate) fn expand(self, bytes: &[u8], most: usize) -> Vec<u8> {
        let mut records = Vec::new();
        match self {
            Self::None => records.extend_from_slice(&bytes[..bytes.len().min(most)]),
            Self::Lz4 => {
                // what came before an error is kept; the chunk's checksum tells whether it is all
                let _ = FrameDecoder::new(bytes)
                    .take(most as u64)
                    .read_to_end(&mut records);
            }
        }
        records
    }
}

impl FromStr for Compression {
    type Err = UnknownCompression;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        match name {
            "none" => Ok(Self::None),
            "lz4" => Ok(Self::Lz4),
            _ => Err(UnknownCompression),
        }
    }
}

impl fmt::Display for Compression {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::None => "none",
            Self::Lz4 => "lz4",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ways_and_never_more_than_allowed() {
        let records: Vec<u8> = (0..2_000_000_u32).map(|i| (i % 251) as u8).collect();
        for compression in [Compression::None, Compression::Lz4] {
            let mut packed = Vec::new();
            compression.compress(&records, &mut packed);
            assert_eq!(compression.expand(&packed, records.len()), records);
            assert_eq!(compression.expand(&packed, 1000), records[..1000]);
            let half = compression.expand(&packed[..packed.len() / 2], records.len());
            assert!(!half.is_empty() && records.starts_with(&half));
            assert_eq!(
                Compression::of_file(compression.in_file()),
                Some(compression)
            );
        }
        assert!(Compression::Lz4.expand(b"no frame at all", 100).is_empty());
    }
}

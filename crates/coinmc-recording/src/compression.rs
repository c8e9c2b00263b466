//! Compression of chunks.

use lz4_flex::frame::{BlockMode, BlockSize, FrameDecoder, FrameEncoder, FrameInfo};
use std::fmt;
use std::io::{Read, Write};
use std::str::FromStr;

/// The compression of chunks.
///
/// # Example
/// ```
/// use coinmc_recording::Compression;
/// assert_eq!("lz4".parse(), Ok(Compression::Lz4));
/// assert!("rar".parse::<Compression>().is_err());
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Compression {
    /// Uncompressed: readable by any tool.
    #[default]
    None,
    /// LZ4 frames, which every MCAP reader supports: JSON full of numbers shrinks by more than
    /// half, Protobuf by a third.
    Lz4,
}

/// An unknown name of a compression.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("compression is `none` or `lz4`")]
pub struct UnknownCompression;

impl Compression {
    /// The name in MCAP files.
    pub(crate) fn mcap_name(self) -> &'static str {
        match self {
            Self::None => "",
            Self::Lz4 => "lz4",
        }
    }

    /// The compression of this name in an MCAP file.
    pub(crate) fn from_mcap_name(name: &str) -> Option<Self> {
        [Self::None, Self::Lz4]
            .into_iter()
            .find(|compression| compression.mcap_name() == name)
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
                // only writing to the sink can fail, and writing to a vector cannot
                let _ = encoder.write_all(records);
                let _ = encoder.finish();
            }
        }
    }

    /// Decompresses `bytes` as far as they are readable, to at most `limit` bytes.
    pub(crate) fn decompress(self, bytes: &[u8], limit: usize) -> Vec<u8> {
        let mut records = Vec::new();
        match self {
            Self::None => records.extend_from_slice(&bytes[..bytes.len().min(limit)]),
            Self::Lz4 => {
                // keep what precedes an error; the chunk's checksum shows whether it is complete
                let _ = FrameDecoder::new(bytes)
                    .take(limit as u64)
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
    fn decompression_restores_the_bytes_and_respects_the_limit() {
        let records: Vec<u8> = (0..2_000_000_u32).map(|i| (i % 251) as u8).collect();
        for compression in [Compression::None, Compression::Lz4] {
            let mut packed = Vec::new();
            compression.compress(&records, &mut packed);
            assert_eq!(compression.decompress(&packed, records.len()), records);
            assert_eq!(compression.decompress(&packed, 1000), records[..1000]);
            let half = compression.decompress(&packed[..packed.len() / 2], records.len());
            assert!(!half.is_empty() && records.starts_with(&half));
            assert_eq!(
                Compression::from_mcap_name(compression.mcap_name()),
                Some(compression)
            );
        }
        assert!(Compression::Lz4.decompress(b"not a frame", 100).is_empty());
    }
}

//! Frames: `0x00 | COBS( session u16 | seq u16 | body | CRC-32 ) | 0x00`, little-endian.
//!
//! Consistent overhead byte stuffing (COBS; Cheshire & Baker 1999, doi:10.1109/90.769765) removes
//! zero bytes from the content, so that a zero always ends a frame and a receiver resynchronises at
//! the next zero, whatever came before. The CRC is CRC-32/ISO-HDLC, as in zlib and PNG; at this
//! length it detects every error of up to three bits and every burst of up to 32 bits.

#[cfg(target_os = "none")]
use crc::NoTable;
use crc::{CRC_32_ISO_HDLC, Crc};
use thiserror::Error;

/// Longest content of a frame before stuffing, bytes.
pub const MAX_PLAIN: usize = 64;
/// Longest message in a frame, bytes: what header (4) and CRC (4) leave.
pub const MAX_BODY: usize = MAX_PLAIN - HEADER - CRC;
/// Longest frame on the wire, bytes: with both zeros and the one byte that stuffing adds.
pub const MAX_WIRE: usize = MAX_PLAIN + 3;

const HEADER: usize = 4;
const CRC: usize = 4;
/// In a microcontroller bit by bit: a table would cost a kilobyte of flash to save negligible time. (The
/// two ways belong to the same crate and give the same sums; with the table, fuzzing is twice as fast.)
#[cfg(target_os = "none")]
static CHECKSUM: Crc<u32, NoTable> = Crc::<u32, NoTable>::new(&CRC_32_ISO_HDLC);
#[cfg(not(target_os = "none"))]
static CHECKSUM: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// The header of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Header {
    /// Session that the host chose in its Hello; never 0.
    pub session: u16,
    /// Sequence number of the request; its reply and repetitions of either have the same.
    pub seq: u16,
}

/// A message is longer than [`MAX_BODY`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("a message of {0} bytes does not fit in a frame (at most {MAX_BODY})")]
pub struct TooLong(pub usize);

/// An encoded frame.
///
/// # Example
/// ```
/// use coinmc_link::{Decoder, Header, Wire};
/// let header = Header { session: 7, seq: 1 };
/// let wire = Wire::new(header, b"hi")?;
/// let mut decoder = Decoder::new();
/// let mut read = None;
/// for byte in wire.as_bytes() {
///     if let Some(Ok(frame)) = decoder.push(*byte) {
///         read = Some((frame.header, frame.body.to_vec()));
///     }
/// }
/// assert_eq!(read, Some((header, b"hi".to_vec())));
/// # Ok::<(), coinmc_link::TooLong>(())
/// ```
#[derive(Debug, Clone)]
pub struct Wire {
    bytes: [u8; MAX_WIRE],
    len: usize,
}

impl Wire {
    /// The frame of this message.
    ///
    /// # Errors
    /// [`TooLong`] if `body` is longer than [`MAX_BODY`].
    pub fn new(header: Header, body: &[u8]) -> Result<Self, TooLong> {
        if body.len() > MAX_BODY {
            return Err(TooLong(body.len()));
        }
        let mut plain = Buffer::<MAX_PLAIN>::new();
        plain.extend(&header.session.to_le_bytes());
        plain.extend(&header.seq.to_le_bytes());
        plain.extend(body);
        let checksum = CHECKSUM.checksum(plain.as_bytes());
        plain.extend(&checksum.to_le_bytes());
        let mut wire = Buffer::<MAX_WIRE>::new();
        wire.push(0);
        // Every block is the bytes up to a zero, preceded by their number plus one: less than 255,
        // because every frame is shorter.
        for block in plain.as_bytes().split(|byte| *byte == 0) {
            wire.push(
                u8::try_from(block.len())
                    .unwrap_or(u8::MAX)
                    .saturating_add(1),
            );
            wire.extend(block);
        }
        wire.push(0);
        Ok(Self {
            bytes: wire.bytes,
            len: wire.len,
        })
    }

    /// The bytes to send.
    pub fn as_bytes(&self) -> &[u8] {
        self.bytes.get(..self.len).unwrap_or_default()
    }
}

impl Default for Wire {
    /// An empty buffer: nothing to send.
    fn default() -> Self {
        Self {
            bytes: [0; MAX_WIRE],
            len: 0,
        }
    }
}

/// A frame that arrived intact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Frame<'a> {
    /// Session and sequence number.
    pub header: Header,
    /// The encoded message, at most [`MAX_BODY`] bytes.
    pub body: &'a [u8],
}

/// Why the bytes between two zeros are not a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum Reject {
    /// Longer than any frame.
    #[error("longer than any frame")]
    TooLong,
    /// They end within a block, or are shorter than header and CRC.
    #[error("cut short")]
    Cut,
    /// Some bytes were changed.
    #[error("wrong CRC")]
    Checksum,
}

/// Decodes frames from bytes as they arrive.
///
/// Its memory is fixed, whatever arrives, and a zero byte always brings it back to the beginning of
/// a frame.
#[derive(Debug, Clone)]
pub struct Decoder {
    plain: Buffer<MAX_PLAIN>,
    position: Position,
    /// Bytes left in this block.
    left: u8,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Position {
    /// After a zero.
    Start,
    /// Within a frame.
    Inside,
    /// Within something longer than any frame.
    Overlong,
}

impl Decoder {
    /// A decoder at the beginning of a frame.
    pub const fn new() -> Self {
        Self {
            plain: Buffer::new(),
            position: Position::Start,
            left: 0,
        }
    }

    /// Takes one byte. The zero that ends a frame returns the frame or the reason to reject it;
    /// additional zeros return nothing.
    pub fn push(&mut self, byte: u8) -> Option<Result<Frame<'_>, Reject>> {
        if byte == 0 {
            return self.end();
        }
        match (self.position, self.left) {
            (Position::Start, _) => {
                self.plain.len = 0;
                self.position = Position::Inside;
                self.left = byte.saturating_sub(1);
            }
            (Position::Inside, 0) => {
                self.keep(0);
                self.left = byte.saturating_sub(1);
            }
            (Position::Inside, left) => {
                self.keep(byte);
                self.left = left.saturating_sub(1);
            }
            (Position::Overlong, _) => {}
        }
        None
    }

    fn keep(&mut self, byte: u8) {
        if !self.plain.push(byte) {
            self.position = Position::Overlong;
        }
    }

    fn end(&mut self) -> Option<Result<Frame<'_>, Reject>> {
        let position = core::mem::replace(&mut self.position, Position::Start);
        let left = core::mem::take(&mut self.left);
        match position {
            Position::Start => None,
            Position::Overlong => Some(Err(Reject::TooLong)),
            Position::Inside if left > 0 => Some(Err(Reject::Cut)),
            Position::Inside => Some(read(self.plain.as_bytes())),
        }
    }
}

impl Default for Decoder {
    fn default() -> Self {
        Self::new()
    }
}

fn read(plain: &[u8]) -> Result<Frame<'_>, Reject> {
    let (content, checksum) = plain.split_last_chunk::<CRC>().ok_or(Reject::Cut)?;
    let (session, rest) = content.split_first_chunk().ok_or(Reject::Cut)?;
    let (seq, body) = rest.split_first_chunk().ok_or(Reject::Cut)?;
    if CHECKSUM.checksum(content) != u32::from_le_bytes(*checksum) {
        return Err(Reject::Checksum);
    }
    Ok(Frame {
        header: Header {
            session: u16::from_le_bytes(*session),
            seq: u16::from_le_bytes(*seq),
        },
        body,
    })
}

/// A buffer of up to `N` bytes.
#[derive(Debug, Clone)]
struct Buffer<const N: usize> {
    bytes: [u8; N],
    len: usize,
}

impl<const N: usize> Buffer<N> {
    const fn new() -> Self {
        Self {
            bytes: [0; N],
            len: 0,
        }
    }

    /// Appends a byte; `false` if the buffer is full.
    fn push(&mut self, byte: u8) -> bool {
        let Some(slot) = self.bytes.get_mut(self.len) else {
            return false;
        };
        *slot = byte;
        self.len = self.len.saturating_add(1);
        true
    }

    fn extend(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.push(*byte);
        }
    }

    fn as_bytes(&self) -> &[u8] {
        self.bytes.get(..self.len).unwrap_or_default()
    }
}

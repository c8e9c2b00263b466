//! Frames: `0x00 | COBS( session u16 | seq u16 | body | CRC-32 ) | 0x00`, little-endian.
//!
//! Consistent overhead byte stuffing (Cheshire & Baker 1999, doi:10.1109/90.769765) takes the zero
//! bytes out of the content, so that a zero always ends a frame: a receiver that lost its place
//! finds it again at the next zero, whatever came before. The CRC is CRC-32/ISO-HDLC, that of zlib
//! and PNG; no error of up to three bits and no burst of up to 32 bits escapes it at this length.

use crc::{CRC_32_ISO_HDLC, Crc, NoTable};
use thiserror::Error;

/// Longest content of a frame before stuffing, bytes.
pub const MAX_PLAIN: usize = 64;
/// Longest message in a frame, bytes: the rest is header (4) and CRC (4).
pub const MAX_BODY: usize = MAX_PLAIN - HEADER - CRC;
/// Longest frame on the wire, bytes: both zeros and the one byte that stuffing adds.
pub const MAX_WIRE: usize = MAX_PLAIN + 3;

const HEADER: usize = 4;
const CRC: usize = 4;
/// Bit by bit: a table would be a kilobyte of flash for microseconds that a serial line never sees.
const CHECKSUM: Crc<u32, NoTable> = Crc::<u32, NoTable>::new(&CRC_32_ISO_HDLC);

/// Who a frame belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Header {
    /// Session that the host chose in its Hello; never 0.
    pub session: u16,
    /// Number of the request; its reply, and a repetition of either, carry the same.
    pub seq: u16,
}

/// A message is longer than [`MAX_BODY`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("a message of {0} bytes does not fit in a frame (at most {MAX_BODY})")]
pub struct TooLong(pub usize);

/// One frame as it goes over the wire.
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
        // Every block is the bytes up to a zero, led by its length plus one: below 255, because a
        // frame is no longer than that.
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

    /// What to send.
    pub fn as_bytes(&self) -> &[u8] {
        self.bytes.get(..self.len).unwrap_or_default()
    }
}

impl Default for Wire {
    /// No frame: nothing to send.
    fn default() -> Self {
        Self {
            bytes: [0; MAX_WIRE],
            len: 0,
        }
    }
}

/// A frame that arrived whole.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Frame<'a> {
    /// Session and number.
    pub header: Header,
    /// The encoded message, at most [`MAX_BODY`] bytes.
    pub body: &'a [u8],
}

/// Why what lay between two zeros is no frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum Reject {
    /// More bytes than any frame has.
    #[error("longer than any frame")]
    TooLong,
    /// It ended within a block, or is shorter than header and CRC.
    #[error("cut short")]
    Cut,
    /// The bytes are not those that were sent.
    #[error("wrong CRC")]
    Checksum,
}

/// Takes bytes as they arrive and gives frames.
///
/// It needs no more than its own memory, whatever arrives, and a zero byte always brings it back to
/// the beginning of a frame.
#[derive(Debug, Clone)]
pub struct Decoder {
    plain: Buffer<MAX_PLAIN>,
    place: Place,
    /// Bytes still to come in this block.
    left: u8,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Place {
    /// After a zero.
    Start,
    /// Within a frame.
    Inside,
    /// Within something too long to be one.
    Overlong,
}

impl Decoder {
    /// A decoder that has seen nothing.
    pub const fn new() -> Self {
        Self {
            plain: Buffer::new(),
            place: Place::Start,
            left: 0,
        }
    }

    /// Takes one byte. It gives something when the byte is the zero after a frame or after
    /// something that is none; zeros in a row are nothing.
    pub fn push(&mut self, byte: u8) -> Option<Result<Frame<'_>, Reject>> {
        if byte == 0 {
            return self.end();
        }
        match (self.place, self.left) {
            (Place::Start, _) => {
                self.plain.len = 0;
                self.place = Place::Inside;
                self.left = byte.saturating_sub(1);
            }
            (Place::Inside, 0) => {
                self.keep(0);
                self.left = byte.saturating_sub(1);
            }
            (Place::Inside, left) => {
                self.keep(byte);
                self.left = left.saturating_sub(1);
            }
            (Place::Overlong, _) => {}
        }
        None
    }

    fn keep(&mut self, byte: u8) {
        if !self.plain.push(byte) {
            self.place = Place::Overlong;
        }
    }

    fn end(&mut self) -> Option<Result<Frame<'_>, Reject>> {
        let place = core::mem::replace(&mut self.place, Place::Start);
        let left = core::mem::take(&mut self.left);
        match place {
            Place::Start => None,
            Place::Overlong => Some(Err(Reject::TooLong)),
            Place::Inside if left > 0 => Some(Err(Reject::Cut)),
            Place::Inside => Some(read(self.plain.as_bytes())),
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

/// Up to `N` bytes.
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

    /// Whether there was room.
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

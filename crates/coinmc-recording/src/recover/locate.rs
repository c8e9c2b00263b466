//! Locating records, by checks that read only a few fields however long a record is.

use super::source::Source;
use crate::encode::{PREFIX, op};
use std::io::{self, Read, Seek};

/// Where a plausible record lies in the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Location {
    pub(super) at: u64,
    pub(super) opcode: u8,
    /// Length of its content.
    pub(super) length: u64,
}

impl Location {
    /// Where its content begins.
    pub(super) fn content(self) -> u64 {
        self.at + PREFIX as u64
    }

    /// Where the next record begins.
    pub(super) fn end(self) -> u64 {
        self.content() + self.length
    }
}

/// Longest name of a compression, bytes.
const LONGEST_NAME: u64 = 32;

/// The record at `at`, if its opcode is known and the lengths in it agree with its own. Only a
/// chunk may extend beyond the file: one that was being written when the file was cut off.
pub(super) fn record_at<R: Read + Seek>(
    source: &mut Source<R>,
    at: u64,
) -> io::Result<Option<Location>> {
    let mut prefix = [0; PREFIX];
    if !source.fill(at, &mut prefix)? {
        return Ok(None);
    }
    let [opcode, length @ ..] = prefix;
    let length = u64::from_le_bytes(length);
    let left = source.length() - at - PREFIX as u64;
    if length > left && opcode != op::CHUNK {
        return Ok(None);
    }
    // so that no sum of lengths below overflows
    if length > i64::MAX as u64 {
        return Ok(None);
    }
    let location = Location { at, opcode, length };
    Ok(is_plausible(source, location)?.then_some(location))
}

fn is_plausible<R: Read + Seek>(source: &mut Source<R>, location: Location) -> io::Result<bool> {
    let length = location.length;
    let content = location.content();
    Ok(match location.opcode {
        op::HEADER | op::METADATA => {
            lengths_fill(source, content, content + length, &[Field::Short; 2])?
        }
        op::FOOTER => length == 20,
        op::SCHEMA => {
            length > 2 && lengths_fill(source, content + 2, content + length, &[Field::Short; 3])?
        }
        op::CHANNEL => {
            length > 4 && lengths_fill(source, content + 4, content + length, &[Field::Short; 3])?
        }
        op::MESSAGE => length >= 22,
        op::CHUNK => is_chunk(source, content, length)?,
        op::MESSAGE_INDEX => {
            length >= 6 && source.u32(content + 2)?.map(u64::from) == Some(length - 6)
        }
        op::ATTACHMENT => {
            let fields = [Field::Short, Field::Short, Field::Long];
            length >= 36 && lengths_fill(source, content + 16, content + length - 4, &fields)?
        }
        op::DATA_END => length == 4,
        op::SUMMARY_OFFSET => length == 17,
        op::CHUNK_INDEX => length >= 60,
        op::ATTACHMENT_INDEX => length >= 48,
        op::STATISTICS => length >= 46,
        op::METADATA_INDEX => length >= 20,
        // nothing else is known about private records
        opcode => opcode >= 0x80,
    })
}

/// A field that begins with its own length.
#[derive(Clone, Copy)]
enum Field {
    /// The length has 32 bits.
    Short,
    /// The length has 64 bits.
    Long,
}

/// Whether these consecutive fields exactly fill the range from `at` to `end`.
fn lengths_fill<R: Read + Seek>(
    source: &mut Source<R>,
    mut at: u64,
    end: u64,
    fields: &[Field],
) -> io::Result<bool> {
    for field in fields {
        let (size, length) = match field {
            Field::Short => (4, source.u32(at)?.map(u64::from)),
            Field::Long => (8, source.u64(at)?),
        };
        let next = length.and_then(|length| at.checked_add(size)?.checked_add(length));
        match next {
            Some(next) if next <= end => at = next,
            _ => return Ok(false),
        }
    }
    Ok(at == end)
}

fn is_chunk<R: Read + Seek>(source: &mut Source<R>, at: u64, length: u64) -> io::Result<bool> {
    let Some(name) = source.u32(at + 28)?.map(u64::from) else {
        return Ok(false);
    };
    if name > LONGEST_NAME {
        return Ok(false);
    }
    let records = source.u64(at + 32 + name)?;
    Ok(records.and_then(|records| records.checked_add(40 + name)) == Some(length))
}

/// The first record at `from` or later that is confirmed: by enough fields of its own, or by the
/// records that follow it.
pub(super) fn find_record<R: Read + Seek>(
    source: &mut Source<R>,
    mut from: u64,
) -> io::Result<Option<Location>> {
    /// Bytes searched at a time.
    const WINDOW: usize = 64 << 10;
    while from + (PREFIX as u64) < source.length() {
        let window = source.read(from, (WINDOW + PREFIX) as u64)?;
        for (i, prefix) in window.windows(PREFIX).enumerate() {
            // no record is 2^40 bytes long, so three bytes of its length are zero
            let likely = matches!(prefix[0], op::SCHEMA..=op::MESSAGE_INDEX)
                || matches!(prefix[0], op::ATTACHMENT | op::METADATA | op::DATA_END);
            if !likely || prefix[6..] != [0; 3] {
                continue;
            }
            let at = from + i as u64;
            if let Some(found) = record_at(source, at)?
                && is_confirmed(source, found)?
            {
                return Ok(Some(found));
            }
        }
        from += window.len().saturating_sub(PREFIX - 1).max(1) as u64;
    }
    Ok(None)
}

fn is_confirmed<R: Read + Seek>(source: &mut Source<R>, found: Location) -> io::Result<bool> {
    Ok(match found.opcode {
        op::CHUNK | op::ATTACHMENT => true,
        _ => {
            let next = record_at(source, found.end())?;
            let Some(next) = next else { return Ok(false) };
            next.opcode == op::CHUNK || record_at(source, next.end())?.is_some()
        }
    })
}

//! Is this a record? Told from a few fields, whatever the record's length.

use super::source::Source;
use crate::wire::{PREFIX, op};
use std::io::{self, Read, Seek};

/// A record that looks like one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Place {
    pub(super) at: u64,
    pub(super) kind: u8,
    /// Of its content.
    pub(super) length: u64,
}

impl Place {
    /// Where its content begins.
    pub(super) fn content(self) -> u64 {
        self.at + PREFIX as u64
    }

    /// Where the next record begins.
    pub(super) fn end(self) -> u64 {
        self.content() + self.length
    }
}

/// Longest compression's name.
const LONGEST_NAME: u64 = 32;

/// The record at `at`, if its kind is known and the lengths in it agree with its own. Only a chunk
/// may reach beyond the file: it was being written when the file was cut off.
pub(super) fn place<R: Read + Seek>(source: &mut Source<R>, at: u64) -> io::Result<Option<Place>> {
    let mut prefix = [0; PREFIX];
    if !source.fill(at, &mut prefix)? {
        return Ok(None);
    }
    let [kind, length @ ..] = prefix;
    let length = u64::from_le_bytes(length);
    let left = source.length() - at - PREFIX as u64;
    if length > left && kind != op::CHUNK {
        return Ok(None);
    }
    // from here on no sum of lengths overflows
    if length > i64::MAX as u64 {
        return Ok(None);
    }
    let place = Place { at, kind, length };
    Ok(has_shape(source, place)?.then_some(place))
}

fn has_shape<R: Read + Seek>(source: &mut Source<R>, place: Place) -> io::Result<bool> {
    let length = place.length;
    let content = place.content();
    Ok(match place.kind {
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
        // of others' own kinds nothing more is known
        kind => kind >= 0x80,
    })
}

/// A field that begins with its own length.
#[derive(Clone, Copy)]
enum Field {
    /// Of 32 bits.
    Short,
    /// Of 64 bits.
    Long,
}

/// Whether these fields, one after the other, reach from `at` to `end` exactly.
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

/// The next record at `from` or later that is surely one: a long shape agrees, or a short one and
/// those of the records after it.
pub(super) fn find<R: Read + Seek>(
    source: &mut Source<R>,
    mut from: u64,
) -> io::Result<Option<Place>> {
    /// Bytes looked through at a time.
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
            if let Some(found) = place(source, at)?
                && is_sure(source, found)?
            {
                return Ok(Some(found));
            }
        }
        from += window.len().saturating_sub(PREFIX - 1).max(1) as u64;
    }
    Ok(None)
}

fn is_sure<R: Read + Seek>(source: &mut Source<R>, found: Place) -> io::Result<bool> {
    Ok(match found.kind {
        op::CHUNK | op::ATTACHMENT => true,
        _ => {
            let next = place(source, found.end())?;
            let Some(next) = next else { return Ok(false) };
            next.kind == op::CHUNK || place(source, next.end())?.is_some()
        }
    })
}

//! Reading a damaged file record by record.

use super::copy::Copy;
use super::locate::{Location, find_record, record_at};
use super::report::Recovered;
use super::source::Source;
use crate::decode::Fields;
use crate::encode::{MAGIC, PREFIX, op};
use crate::error::Error;
use crate::sink::Sink;
use crate::writer::{MAX_RECORD, Options, Writer};
use std::io::{self, Read, Seek};

/// Why nothing was recovered.
pub(super) enum Failure {
    NotMcap,
    Read(io::Error),
    Write(Error),
}

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        Self::Read(error)
    }
}

/// Copies what is readable in `input` to `out`.
pub(super) fn walk<R: Read + Seek, S: Sink>(input: R, out: S) -> Result<(Recovered, S), Failure> {
    let mut source = Source::new(input)?;
    let (options, mut at, mut lost) = read_header(&mut source)?;
    let writer = Writer::new(out, &options).map_err(Failure::Write)?;
    let mut copy = Copy::new(writer);
    let mut had_end = false;
    while at < source.length() {
        let Some(found) = record_at(&mut source, at)? else {
            let next = find_record(&mut source, at + 1)?.map_or(source.length(), |next| next.at);
            lost += next - at;
            at = next;
            continue;
        };
        match found.opcode {
            op::DATA_END => {
                had_end = has_end_magic(&mut source)?;
                break;
            }
            op::FOOTER => break,
            _ => {}
        }
        let end = found.end().min(source.length());
        if is_free_form(found.opcode) && !record_or_end_at(&mut source, end)? {
            // only its length says where it ends, and the length is wrong
            let next = find_record(&mut source, at + 1)?.map_or(source.length(), |next| next.at);
            lost += next - at;
            at = next;
            continue;
        }
        if !copy_record(&mut source, &mut copy, found)? {
            lost += end - at;
        }
        at = end;
    }
    copy.report.lost_bytes = lost;
    copy.report.had_end = had_end;
    copy.finish().map_err(Failure::Write)
}

/// Options from the header, the offset of the first record after it, and bytes lost so far.
fn read_header<R: Read + Seek>(source: &mut Source<R>) -> Result<(Options, u64, u64), Failure> {
    let start = MAGIC.len() as u64;
    let mut magic = [0; MAGIC.len()];
    let has_magic = source.fill(0, &mut magic)? && magic == MAGIC;
    let header = record_at(source, start)?.filter(|found| found.opcode == op::HEADER);
    let lost = if has_magic { 0 } else { start };
    let Some(header) = header else {
        if has_magic {
            return Ok((Options::default(), start, lost));
        }
        return Err(Failure::NotMcap);
    };
    let content = source.read(header.content(), header.length.min(MAX_RECORD))?;
    let mut fields = Fields::new(&content);
    let mut text = || fields.str().unwrap_or_default().to_owned();
    let options = Options {
        profile: text(),
        library: text(),
        ..Options::default()
    };
    Ok((options, header.end(), lost))
}

/// Copies a record; whether all of it was readable.
fn copy_record<R: Read + Seek, S: Sink>(
    source: &mut Source<R>,
    copy: &mut Copy<S>,
    found: Location,
) -> Result<bool, Failure> {
    let is_torn = found.end() > source.length();
    let wanted = matches!(
        found.opcode,
        op::SCHEMA | op::CHANNEL | op::MESSAGE | op::CHUNK | op::ATTACHMENT | op::METADATA
    );
    if !wanted {
        // the new file gets new indexes; private records are not copied
        return Ok(found.opcode < 0x80);
    }
    if found.length > MAX_RECORD && !is_torn {
        return Ok(false);
    }
    let content = source.read(found.content(), found.length.min(MAX_RECORD))?;
    let copied = if found.opcode == op::CHUNK {
        copy.chunk(&content, is_torn)
    } else {
        copy.record(found.opcode, &content)
    };
    copied.map_err(Failure::Write)
}

/// Whether nothing in such a record confirms its length.
fn is_free_form(opcode: u8) -> bool {
    opcode == op::MESSAGE || opcode >= 0x80
}

/// Whether the file ends at `at` or a record begins there, possibly one that is cut off.
fn record_or_end_at<R: Read + Seek>(source: &mut Source<R>, at: u64) -> io::Result<bool> {
    let mut prefix = [0; PREFIX];
    if !source.fill(at, &mut prefix)? || record_at(source, at)?.is_some() {
        return Ok(true);
    }
    let length = prefix[1..]
        .iter()
        .rfold(0, |n, &byte| n << 8 | u64::from(byte));
    let left = source.length() - at - PREFIX as u64;
    Ok(matches!(prefix[0], op::HEADER..=op::DATA_END) && length > left)
}

fn has_end_magic<R: Read + Seek>(source: &mut Source<R>) -> io::Result<bool> {
    let mut magic = [0; MAGIC.len()];
    let at = source.length() - MAGIC.len() as u64;
    Ok(source.fill(at, &mut magic)? && magic == MAGIC)
}

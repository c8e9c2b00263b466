//! The walk through a damaged file.

use super::Recovered;
use super::copy::Copy;
use super::shape::{Place, find, place};
use super::source::Source;
use crate::error::Error;
use crate::fields::Fields;
use crate::sink::Sink;
use crate::wire::{MAGIC, PREFIX, op};
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

/// Reads what can be read of `input` into `out`.
pub(super) fn walk<R: Read + Seek, S: Sink>(input: R, out: S) -> Result<(Recovered, S), Failure> {
    let mut source = Source::new(input)?;
    let (options, mut at, mut lost) = beginning(&mut source)?;
    let writer = Writer::new(out, &options).map_err(Failure::Write)?;
    let mut copy = Copy::new(writer);
    let mut had_end = false;
    while at < source.length() {
        let Some(found) = place(&mut source, at)? else {
            let next = find(&mut source, at + 1)?.map_or(source.length(), |next| next.at);
            lost += next - at;
            at = next;
            continue;
        };
        match found.kind {
            op::DATA_END => {
                had_end = ends_well(&mut source)?;
                break;
            }
            op::FOOTER => break,
            _ => {}
        }
        let end = found.end().min(source.length());
        if is_free_form(found.kind) && !goes_on(&mut source, end)? {
            // its length alone says where it ends, and that is wrong
            let next = find(&mut source, at + 1)?.map_or(source.length(), |next| next.at);
            lost += next - at;
            at = next;
            continue;
        }
        if !take(&mut source, &mut copy, found)? {
            lost += end - at;
        }
        at = end;
    }
    copy.report.lost_bytes = lost;
    copy.report.had_end = had_end;
    copy.finish().map_err(Failure::Write)
}

/// What the file says of itself, where its records begin, and bytes lost so far.
fn beginning<R: Read + Seek>(source: &mut Source<R>) -> Result<(Options, u64, u64), Failure> {
    let start = MAGIC.len() as u64;
    let mut magic = [0; MAGIC.len()];
    let has_magic = source.fill(0, &mut magic)? && magic == MAGIC;
    let header = place(source, start)?.filter(|found| found.kind == op::HEADER);
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

/// Copies a record; whether all of it made sense.
fn take<R: Read + Seek, S: Sink>(
    source: &mut Source<R>,
    copy: &mut Copy<S>,
    found: Place,
) -> Result<bool, Failure> {
    let is_torn = found.end() > source.length();
    let wanted = matches!(
        found.kind,
        op::SCHEMA | op::CHANNEL | op::MESSAGE | op::CHUNK | op::ATTACHMENT | op::METADATA
    );
    if !wanted {
        // indexes are made anew; what others' own kinds hold is not kept
        return Ok(found.kind < 0x80);
    }
    if found.length > MAX_RECORD && !is_torn {
        return Ok(false);
    }
    let content = source.read(found.content(), found.length.min(MAX_RECORD))?;
    let taken = if found.kind == op::CHUNK {
        copy.chunk(&content, is_torn)
    } else {
        copy.record(found.kind, &content)
    };
    taken.map_err(Failure::Write)
}

/// Records that can be of any length whatever they hold.
fn is_free_form(kind: u8) -> bool {
    kind == op::MESSAGE || kind >= 0x80
}

/// Whether at `at` the file ends, or a record begins, be it one that was cut off.
fn goes_on<R: Read + Seek>(source: &mut Source<R>, at: u64) -> io::Result<bool> {
    let mut prefix = [0; PREFIX];
    if !source.fill(at, &mut prefix)? || place(source, at)?.is_some() {
        return Ok(true);
    }
    let length = prefix[1..]
        .iter()
        .rfold(0, |n, &byte| n << 8 | u64::from(byte));
    let left = source.length() - at - PREFIX as u64;
    Ok(matches!(prefix[0], op::HEADER..=op::DATA_END) && length > left)
}

fn ends_well<R: Read + Seek>(source: &mut Source<R>) -> io::Result<bool> {
    let mut magic = [0; MAGIC.len()];
    let at = source.length() - MAGIC.len() as u64;
    Ok(source.fill(at, &mut magic)? && magic == MAGIC)
}

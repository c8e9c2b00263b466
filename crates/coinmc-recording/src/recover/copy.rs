//! Copying readable records to a new file.

use super::report::Recovered;
use crate::chunk::{RawChannel, RawMessage, RawSchema};
use crate::compression::Compression;
use crate::decode::Fields;
use crate::encode::op;
use crate::error::Error;
use crate::sink::Sink;
use crate::writer::{Attachment, MAX_RECORD, Writer};
use std::collections::HashMap;

/// Greatest total length of schemas and channels that are kept, bytes: far more than a recording
/// needs, and a malicious file cannot fill the memory.
const MAX_DEFINITIONS: usize = 32 << 20;

/// The new file, and the ids there of the old file's schemas and channels.
pub(super) struct Copy<S> {
    writer: Writer<S>,
    schemas: HashMap<u16, u16>,
    channels: HashMap<u16, u16>,
    pub(super) report: Recovered,
}

/// The header of a chunk and its records as stored.
struct StoredChunk<'a> {
    size: u64,
    crc: u32,
    compression: Option<Compression>,
    records: &'a [u8],
}

impl<S: Sink> Copy<S> {
    pub(super) fn new(writer: Writer<S>) -> Self {
        Self {
            writer,
            schemas: HashMap::new(),
            channels: HashMap::new(),
            report: Recovered::default(),
        }
    }

    pub(super) fn finish(mut self) -> Result<(Recovered, S), Error> {
        self.report.messages = self.writer.messages();
        self.report.channels = self.writer.channels();
        Ok((self.report, self.writer.finish()?))
    }

    /// Copies a record that is not a chunk; whether it was readable.
    pub(super) fn record(&mut self, opcode: u8, content: &[u8]) -> Result<bool, Error> {
        let copied = match opcode {
            op::SCHEMA => self.schema(content),
            op::CHANNEL => self.channel(content),
            op::MESSAGE => return self.message(content),
            op::METADATA => return self.metadata(content),
            op::ATTACHMENT => return self.attachment(content),
            _ => Some(()),
        };
        Ok(copied.is_some())
    }

    /// Copies the messages of a chunk, which may be cut off by the end of the file (`is_torn`);
    /// whether all of it was readable.
    pub(super) fn chunk(&mut self, content: &[u8], is_torn: bool) -> Result<bool, Error> {
        let Some(stored) = stored_chunk(content) else {
            self.report.lost_chunks += 1;
            return Ok(false);
        };
        let Some(compression) = stored.compression else {
            self.report.lost_chunks += 1;
            self.report.unknown_compression += 1;
            return Ok(false);
        };
        let limit = usize::try_from(stored.size.min(MAX_RECORD)).unwrap_or(usize::MAX);
        let decompressed;
        let records = match compression {
            Compression::None => &stored.records[..stored.records.len().min(limit)],
            Compression::Lz4 => {
                decompressed = compression.decompress(stored.records, limit);
                &decompressed[..]
            }
        };
        let intact = records.len() as u64 == stored.size
            && (stored.crc == 0 || crc32fast::hash(records) == stored.crc);
        // the beginning of a torn chunk can be trusted, but nothing of a damaged one
        let whole = if intact || is_torn {
            self.writer.set_compression(compression);
            self.records(records)? && intact
        } else {
            false
        };
        self.report.lost_chunks += u64::from(!whole);
        Ok(whole)
    }

    /// Copies the records of a chunk up to the first unreadable one; whether all were readable.
    fn records(&mut self, records: &[u8]) -> Result<bool, Error> {
        let mut fields = Fields::new(records);
        while !fields.rest().is_empty() {
            let Some((opcode, content)) = fields.record() else {
                return Ok(false);
            };
            let is_allowed =
                matches!(opcode, op::SCHEMA | op::CHANNEL | op::MESSAGE) || opcode >= 0x80;
            if !is_allowed || !self.record(opcode, content)? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    fn schema(&mut self, content: &[u8]) -> Option<()> {
        let mut fields = Fields::new(content);
        let id = fields.u16().filter(|&id| id != 0)?;
        let schema = RawSchema {
            name: fields.str()?.to_owned(),
            encoding: fields.str()?.to_owned(),
            data: fields.bytes()?.to_vec(),
        };
        self.check_definitions(content)?;
        self.schemas.insert(id, self.writer.schema(schema).ok()?);
        Some(())
    }

    fn channel(&mut self, content: &[u8]) -> Option<()> {
        let mut fields = Fields::new(content);
        let id = fields.u16()?;
        let schema = match fields.u16()? {
            0 => 0,
            schema => *self.schemas.get(&schema)?,
        };
        let channel = RawChannel {
            schema,
            topic: fields.str()?.to_owned(),
            encoding: fields.str()?.to_owned(),
            metadata: fields.map()?,
        };
        self.check_definitions(content)?;
        self.channels.insert(id, self.writer.channel(channel).ok()?);
        Some(())
    }

    /// `None` if another definition would exceed the limit.
    fn check_definitions(&self, content: &[u8]) -> Option<()> {
        (self.writer.definitions() + content.len() <= MAX_DEFINITIONS).then_some(())
    }

    fn message(&mut self, content: &[u8]) -> Result<bool, Error> {
        let Some((mut message, source)) = message(content) else {
            return Ok(false);
        };
        let Some(&channel) = self.channels.get(&source) else {
            self.report.lost_messages += 1;
            return Ok(true);
        };
        message.channel = channel;
        let kept = self.unless_too_long(|writer| writer.message(message))?;
        self.report.lost_messages += u64::from(!kept);
        Ok(true)
    }

    fn metadata(&mut self, content: &[u8]) -> Result<bool, Error> {
        let mut fields = Fields::new(content);
        let (Some(name), Some(map)) = (fields.str(), fields.map()) else {
            return Ok(false);
        };
        let kept = self.unless_too_long(|writer| writer.metadata(name, &map))?;
        self.report.metadata += u64::from(kept);
        Ok(kept)
    }

    fn attachment(&mut self, content: &[u8]) -> Result<bool, Error> {
        let Some((attachment, crc)) = attachment(content) else {
            return Ok(false);
        };
        if crc != 0 && crc32fast::hash(&content[..content.len() - 4]) != crc {
            return Ok(false);
        }
        let kept = self.unless_too_long(|writer| writer.attachment(&attachment))?;
        self.report.attachments += u64::from(kept);
        Ok(kept)
    }

    /// Writes a record unless it is too long: another program may have a greater limit.
    fn unless_too_long(
        &mut self,
        write: impl FnOnce(&mut Writer<S>) -> Result<(), Error>,
    ) -> Result<bool, Error> {
        match write(&mut self.writer) {
            Err(Error::TooLong { .. }) => Ok(false),
            written => written.map(|()| true),
        }
    }
}

fn stored_chunk(content: &[u8]) -> Option<StoredChunk<'_>> {
    let mut fields = Fields::new(content);
    fields.take(16)?;
    let (size, crc) = (fields.u64()?, fields.u32()?);
    let compression = fields.str().map(Compression::from_mcap_name)?;
    fields.u64()?;
    Some(StoredChunk {
        size,
        crc,
        compression,
        records: fields.rest(),
    })
}

fn message(content: &[u8]) -> Option<(RawMessage<'_>, u16)> {
    let mut fields = Fields::new(content);
    let channel = fields.u16()?;
    let message = RawMessage {
        channel,
        sequence: fields.u32()?,
        log_time: fields.u64()?,
        publish_time: fields.u64()?,
        data: fields.rest(),
    };
    Some((message, channel))
}

fn attachment(content: &[u8]) -> Option<(Attachment<'_>, u32)> {
    let mut fields = Fields::new(content);
    let (log_time_ns, create_time_ns) = (fields.u64()?, fields.u64()?);
    let (name, media_type) = (fields.str()?, fields.str()?);
    let length = usize::try_from(fields.u64()?).ok()?;
    let data = fields.take(length)?;
    let crc = fields.u32()?;
    let attachment = Attachment {
        name,
        media_type,
        log_time_ns,
        create_time_ns,
        data,
    };
    Some((attachment, crc))
}

//! From records read to a new file.

use super::Recovered;
use crate::chunk::{RawChannel, RawMessage, RawSchema};
use crate::compression::Compression;
use crate::error::Error;
use crate::fields::Fields;
use crate::sink::Sink;
use crate::wire::op;
use crate::writer::{Attachment, MAX_RECORD, Writer};
use std::collections::HashMap;

/// Most bytes of schemas and channels kept, all together.
const MOST_DEFINITIONS: usize = 128 << 20;

/// The new file, and how the old file's ids are called there.
pub(super) struct Copy<S> {
    writer: Writer<S>,
    schemas: HashMap<u16, u16>,
    channels: HashMap<u16, u16>,
    pub(super) report: Recovered,
}

/// A chunk's head and its records as they lie in the file.
struct Packed<'a> {
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

    /// Takes over a record that is no chunk; whether it made sense.
    pub(super) fn record(&mut self, kind: u8, content: &[u8]) -> Result<bool, Error> {
        let taken = match kind {
            op::SCHEMA => self.schema(content),
            op::CHANNEL => self.channel(content),
            op::MESSAGE => return self.message(content),
            op::METADATA => return self.metadata(content),
            op::ATTACHMENT => return self.attachment(content),
            _ => Some(()),
        };
        Ok(taken.is_some())
    }

    /// Takes over the messages of a chunk, `content` being as much of it as is there; whether all
    /// of it made sense.
    pub(super) fn chunk(&mut self, content: &[u8], is_torn: bool) -> Result<bool, Error> {
        let Some(packed) = packed(content) else {
            self.report.lost_chunks += 1;
            return Ok(false);
        };
        let Some(compression) = packed.compression else {
            self.report.lost_chunks += 1;
            self.report.unknown_compression += 1;
            return Ok(false);
        };
        let most = usize::try_from(packed.size.min(MAX_RECORD)).unwrap_or(usize::MAX);
        let expanded;
        let records = match compression {
            Compression::None => &packed.records[..packed.records.len().min(most)],
            Compression::Lz4 => {
                expanded = compression.expand(packed.records, most);
                &expanded[..]
            }
        };
        let intact = records.len() as u64 == packed.size
            && (packed.crc == 0 || crc32fast::hash(records) == packed.crc);
        // of a torn chunk what is there may be believed, of a damaged one nothing
        let whole = if intact || is_torn {
            self.writer.set_compression(compression);
            self.records(records)? && intact
        } else {
            false
        };
        self.report.lost_chunks += u64::from(!whole);
        Ok(whole)
    }

    /// Takes over the records within a chunk as far as they make sense; whether they all do.
    fn records(&mut self, records: &[u8]) -> Result<bool, Error> {
        let mut fields = Fields::new(records);
        while !fields.rest().is_empty() {
            let Some((kind, content)) = fields.record() else {
                return Ok(false);
            };
            let belongs = matches!(kind, op::SCHEMA | op::CHANNEL | op::MESSAGE) || kind >= 0x80;
            if !belongs || !self.record(kind, content)? {
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
        self.may_keep(content)?;
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
        self.may_keep(content)?;
        self.channels.insert(id, self.writer.channel(channel).ok()?);
        Some(())
    }

    /// Whether there is room for another definition: far more than a recording defines, and a
    /// malicious one cannot fill the memory.
    fn may_keep(&self, content: &[u8]) -> Option<()> {
        (self.writer.definitions() + content.len() <= MOST_DEFINITIONS).then_some(())
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
        let kept = self.fits(|writer| writer.message(message))?;
        self.report.lost_messages += u64::from(!kept);
        Ok(true)
    }

    fn metadata(&mut self, content: &[u8]) -> Result<bool, Error> {
        let mut fields = Fields::new(content);
        let (Some(name), Some(map)) = (fields.str(), fields.map()) else {
            return Ok(false);
        };
        let kept = self.fits(|writer| writer.metadata(name, &map))?;
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
        let kept = self.fits(|writer| writer.attachment(&attachment))?;
        self.report.attachments += u64::from(kept);
        Ok(kept)
    }

    /// Writes a piece; another program's may be longer than this one writes them.
    fn fits(
        &mut self,
        write: impl FnOnce(&mut Writer<S>) -> Result<(), Error>,
    ) -> Result<bool, Error> {
        match write(&mut self.writer) {
            Err(Error::TooLong { .. }) => Ok(false),
            written => written.map(|()| true),
        }
    }
}

fn packed(content: &[u8]) -> Option<Packed<'_>> {
    let mut fields = Fields::new(content);
    fields.take(16)?;
    let (size, crc) = (fields.u64()?, fields.u32()?);
    let compression = fields.str().map(Compression::of_file)?;
    fields.u64()?;
    Some(Packed {
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

//! The untyped writer: schemas, channels, messages, metadata and attachments as MCAP records.

use crate::chunk::{Chunk, RawChannel, RawMessage, RawSchema};
use crate::compression::Compression;
use crate::encode::{MAGIC, Put, op, record};
use crate::encoding::Encoding;
use crate::error::Error;
use crate::sink::Sink;
use crate::summary::{AttachmentIndex, MetadataIndex, Summary, UsedChannel};
use std::collections::{BTreeMap, HashMap};
use std::hash::Hash;
use std::io;

/// Longest record that is read back, which bounds what a damaged length can cost in memory. The
/// longest chunk that is ever written is shorter: full but for one byte, plus the longest message
/// with the definition of its channel.
pub(crate) const MAX_RECORD: u64 = 256 << 20;
/// Longest message, schema, channel, attachment or metadata, bytes.
const MAX_PIECE: u64 = 64 << 20;
/// A chunk ends once it holds this many uncompressed bytes.
const CHUNK: usize = 1 << 20;

/// A recording's header, and how its messages are written.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// The MCAP profile, a name for conventions that the recording follows; may be empty.
    pub profile: String,
    /// The program that writes the recording, with its version.
    pub library: String,
    /// Compression of the chunks.
    pub compression: Compression,
    /// Encoding of the messages.
    pub encoding: Encoding,
}

/// Data that is not a message, such as a config, an image or a log.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Attachment<'a> {
    /// Name, like a file's.
    pub name: &'a str,
    /// Media type, such as `text/plain`.
    pub media_type: &'a str,
    /// When it was recorded, ns.
    pub log_time_ns: u64,
    /// When it was created, ns; 0 if unknown.
    pub create_time_ns: u64,
    /// The data.
    pub data: &'a [u8],
}

/// Values with ids; equal values share an id.
#[derive(Debug)]
struct Ids<T> {
    values: Vec<T>,
    known: HashMap<T, u16>,
    /// The first id.
    base: u16,
}

impl<T: Clone + Eq + Hash> Ids<T> {
    fn new(base: u16) -> Self {
        Self {
            values: Vec::new(),
            known: HashMap::new(),
            base,
        }
    }

    fn id(&mut self, value: T, what: &'static str) -> Result<u16, Error> {
        if let Some(&id) = self.known.get(&value) {
            return Ok(id);
        }
        let id = u16::try_from(self.values.len())
            .ok()
            .and_then(|n| n.checked_add(self.base))
            .filter(|&id| id < u16::MAX)
            .ok_or(Error::TooMany { what })?;
        self.values.push(value.clone());
        self.known.insert(value, id);
        Ok(id)
    }

    fn get(&self, id: u16) -> Option<&T> {
        self.values.get(usize::from(id.checked_sub(self.base)?))
    }

    fn iter(&self) -> impl Iterator<Item = (u16, &T)> {
        (self.base..=u16::MAX).zip(&self.values)
    }
}

/// Writes an MCAP file sequentially to a sink.
#[derive(Debug)]
pub(crate) struct Writer<S> {
    out: S,
    position: u64,
    crc: crc32fast::Hasher,
    compression: Compression,
    schemas: Ids<RawSchema>,
    channels: Ids<RawChannel>,
    /// Number of messages by channel.
    messages: Vec<u64>,
    /// Bytes of all schemas and channels.
    definitions: usize,
    chunk: Chunk,
    summary: Summary,
    scratch: Vec<u8>,
    /// A write failed, so that anything written after it would not be readable.
    broken: bool,
}

impl<S: Sink> Writer<S> {
    pub(crate) fn new(out: S, options: &Options) -> Result<Self, Error> {
        let mut writer = Self {
            out,
            position: 0,
            crc: crc32fast::Hasher::new(),
            compression: options.compression,
            schemas: Ids::new(1),
            channels: Ids::new(0),
            messages: Vec::new(),
            definitions: 0,
            chunk: Chunk::default(),
            summary: Summary::default(),
            scratch: Vec::new(),
            broken: false,
        };
        check_length("a name", options.profile.len() + options.library.len())?;
        writer.scratch.extend_from_slice(&MAGIC);
        record(&mut writer.scratch, op::HEADER, |bytes| {
            bytes.put_str(&options.profile);
            bytes.put_str(&options.library);
        });
        writer.emit()?;
        Ok(writer)
    }

    /// Sets the compression of the current chunk and those after it.
    pub(crate) fn set_compression(&mut self, compression: Compression) {
        self.compression = compression;
    }

    /// Number of messages on all channels.
    pub(crate) fn messages(&self) -> u64 {
        self.messages.iter().sum()
    }

    /// Number of channels that have messages.
    pub(crate) fn channels(&self) -> usize {
        self.messages.iter().filter(|&&n| n > 0).count()
    }

    pub(crate) fn topic(&self, channel: u16) -> &str {
        self.channels.get(channel).map_or("", |c| &c.topic)
    }

    /// Adds a schema, unless it is known; its id.
    pub(crate) fn schema(&mut self, schema: RawSchema) -> Result<u16, Error> {
        let length = schema.name.len() + schema.encoding.len() + schema.data.len();
        check_length("a schema", length)?;
        let known = self.schemas.values.len();
        let id = self.schemas.id(schema, "schemas")?;
        if self.schemas.values.len() > known {
            self.definitions += length;
        }
        Ok(id)
    }

    /// Adds a channel, unless it is known; its id.
    pub(crate) fn channel(&mut self, channel: RawChannel) -> Result<u16, Error> {
        let length = channel.topic.len() + channel.encoding.len() + map_length(&channel.metadata);
        check_length("a channel", length)?;
        let id = self.channels.id(channel, "channels")?;
        if self.channels.values.len() > self.messages.len() {
            self.messages.push(0);
            self.definitions += length;
        }
        Ok(id)
    }

    /// Bytes of all distinct schemas and channels.
    pub(crate) fn definitions(&self) -> usize {
        self.definitions
    }

    /// Adds a message on a channel that was added by [`channel`](Self::channel).
    pub(crate) fn message(&mut self, message: RawMessage<'_>) -> Result<(), Error> {
        self.check_unbroken()?;
        check_length("a message", message.data.len())?;
        let id = message.channel;
        if !self.chunk.defines(id) {
            let channel = self.channels.get(id).expect("ids come from `channel`");
            self.chunk
                .define(id, channel, self.schemas.get(channel.schema));
        }
        self.chunk.push(message);
        self.messages[usize::from(id)] += 1;
        self.summary.message(message.log_time);
        if self.chunk.is_full(CHUNK) {
            self.end_chunk()?;
        }
        Ok(())
    }

    /// Number of messages on a channel so far.
    pub(crate) fn count(&self, channel: u16) -> u64 {
        self.messages
            .get(usize::from(channel))
            .copied()
            .unwrap_or(0)
    }

    /// Ends the chunk and makes everything so far durable.
    pub(crate) fn flush(&mut self) -> Result<(), Error> {
        self.end_chunk()?;
        let synced = self.out.sync();
        self.mark_if_broken(synced)
    }

    pub(crate) fn metadata(
        &mut self,
        name: &str,
        map: &BTreeMap<String, String>,
    ) -> Result<(), Error> {
        check_length("metadata", name.len() + map_length(map))?;
        self.check_unbroken()?;
        let offset = self.position;
        record(&mut self.scratch, op::METADATA, |bytes| {
            bytes.put_str(name);
            bytes.put_map(map);
        });
        let index = MetadataIndex {
            offset,
            length: self.emit()?,
            name: name.to_owned(),
        };
        self.summary.metadata(index);
        Ok(())
    }

    pub(crate) fn attachment(&mut self, attachment: &Attachment<'_>) -> Result<(), Error> {
        let length = attachment.name.len() + attachment.media_type.len() + attachment.data.len();
        check_length("an attachment", length)?;
        self.check_unbroken()?;
        let offset = self.position;
        record(&mut self.scratch, op::ATTACHMENT, |bytes| {
            let from = bytes.len();
            bytes.put_u64(attachment.log_time_ns);
            bytes.put_u64(attachment.create_time_ns);
            bytes.put_str(attachment.name);
            bytes.put_str(attachment.media_type);
            bytes.put_u64(attachment.data.len() as u64);
            bytes.extend_from_slice(attachment.data);
            let crc = crc32fast::hash(&bytes[from..]);
            bytes.put_u32(crc);
        });
        let index = AttachmentIndex {
            offset,
            length: self.emit()?,
            log_time: attachment.log_time_ns,
            create_time: attachment.create_time_ns,
            data_size: attachment.data.len() as u64,
            name: attachment.name.to_owned(),
            media_type: attachment.media_type.to_owned(),
        };
        self.summary.attachment(index);
        Ok(())
    }

    /// Writes the end of the file and returns the sink.
    pub(crate) fn finish(mut self) -> Result<S, Error> {
        self.end_chunk()?;
        let crc = self.crc.clone().finalize();
        record(&mut self.scratch, op::DATA_END, |bytes| bytes.put_u32(crc));
        self.emit()?;
        let used: Vec<UsedChannel<'_>> = self
            .channels
            .iter()
            .zip(&self.messages)
            .filter(|(_, messages)| **messages > 0)
            .map(|((id, channel), &messages)| UsedChannel {
                id,
                channel,
                messages,
            })
            .collect();
        let is_used = |id: u16| used.iter().any(|used| used.channel.schema == id);
        let schemas: Vec<_> = self.schemas.iter().filter(|(id, _)| is_used(*id)).collect();
        let end = self.summary.encode(self.position, &schemas, &used);
        self.out.write_all(&end)?;
        self.out.sync()?;
        Ok(self.out)
    }

    fn end_chunk(&mut self) -> Result<(), Error> {
        self.check_unbroken()?;
        if self.chunk.is_empty() {
            return Ok(());
        }
        let offset = self.position;
        let layout = self.chunk.finish(self.compression, &mut self.scratch);
        self.emit()?;
        self.summary
            .chunk(offset, layout, self.compression.mcap_name());
        Ok(())
    }

    /// Writes the scratch buffer; its length.
    fn emit(&mut self) -> Result<u64, Error> {
        let length = self.scratch.len() as u64;
        self.crc.update(&self.scratch);
        let written = self.out.write_all(&self.scratch);
        self.scratch.clear();
        self.mark_if_broken(written)?;
        self.position += length;
        Ok(length)
    }

    fn check_unbroken(&self) -> Result<(), Error> {
        if self.broken {
            Err(Error::Broken)
        } else {
            Ok(())
        }
    }

    fn mark_if_broken(&mut self, written: io::Result<()>) -> Result<(), Error> {
        self.broken |= written.is_err();
        written.map_err(Error::Stream)
    }
}

fn map_length(map: &BTreeMap<String, String>) -> usize {
    map.iter().map(|(k, v)| 8 + k.len() + v.len()).sum()
}

/// Rejects what does not fit a 32-bit length or could not be read back by [`crate::recover()`].
fn check_length(what: &'static str, length: usize) -> Result<(), Error> {
    if length as u64 > MAX_PIECE {
        return Err(Error::TooLong {
            what,
            limit: MAX_PIECE,
        });
    }
    Ok(())
}

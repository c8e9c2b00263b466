//! Chunks: messages and the definitions they need, written as one record.

use crate::compression::Compression;
use crate::encode::{Put, op, record};
use std::collections::{BTreeMap, BTreeSet};

/// A message as MCAP stores it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RawMessage<'a> {
    pub(crate) channel: u16,
    pub(crate) sequence: u32,
    pub(crate) log_time: u64,
    pub(crate) publish_time: u64,
    pub(crate) data: &'a [u8],
}

/// A schema as MCAP stores it, without its id.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(crate) struct RawSchema {
    pub(crate) name: String,
    pub(crate) encoding: String,
    pub(crate) data: Vec<u8>,
}

/// A channel as MCAP stores it, without its id.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(crate) struct RawChannel {
    /// Id of its schema; 0 for none.
    pub(crate) schema: u16,
    pub(crate) topic: String,
    pub(crate) encoding: String,
    pub(crate) metadata: BTreeMap<String, String>,
}

impl RawSchema {
    pub(crate) fn put(&self, id: u16, bytes: &mut Vec<u8>) {
        record(bytes, op::SCHEMA, |bytes| {
            bytes.put_u16(id);
            bytes.put_str(&self.name);
            bytes.put_str(&self.encoding);
            bytes.put_bytes(&self.data);
        });
    }
}

impl RawChannel {
    pub(crate) fn put(&self, id: u16, bytes: &mut Vec<u8>) {
        record(bytes, op::CHANNEL, |bytes| {
            bytes.put_u16(id);
            bytes.put_u16(self.schema);
            bytes.put_str(&self.topic);
            bytes.put_str(&self.encoding);
            bytes.put_map(&self.metadata);
        });
    }
}

/// A chunk that is being filled.
#[derive(Debug, Default)]
pub(crate) struct Chunk {
    records: Vec<u8>,
    /// Bytes of schemas and channels among them.
    definitions: usize,
    /// By channel: log time and offset of every message.
    index: BTreeMap<u16, Vec<(u64, u64)>>,
    schemas: BTreeSet<u16>,
    start: u64,
    end: u64,
}

/// Offsets and lengths of a finished chunk's parts, from its first byte.
#[derive(Debug)]
pub(crate) struct ChunkLayout {
    pub(crate) start: u64,
    pub(crate) end: u64,
    pub(crate) length: u64,
    pub(crate) index_offsets: Vec<(u16, u64)>,
    pub(crate) index_length: u64,
    pub(crate) compressed: u64,
    pub(crate) uncompressed: u64,
}

impl Chunk {
    pub(crate) fn is_empty(&self) -> bool {
        self.records.is_empty()
    }

    /// Whether it has `least` uncompressed bytes, and as many of messages as of definitions: since every chunk
    /// repeats these, a file would else be mostly schemas, and a small one could be recovered to a huge one.
    pub(crate) fn is_full(&self, least: usize) -> bool {
        self.records.len() >= least.max(2 * self.definitions)
    }

    /// Whether this chunk defines the channel.
    pub(crate) fn defines(&self, channel: u16) -> bool {
        self.index.contains_key(&channel)
    }

    /// Defines a channel in this chunk, so that it can be read even if all others are lost.
    pub(crate) fn define(&mut self, id: u16, channel: &RawChannel, schema: Option<&RawSchema>) {
        let before = self.records.len();
        if let Some(schema) = schema
            && self.schemas.insert(channel.schema)
        {
            schema.put(channel.schema, &mut self.records);
        }
        channel.put(id, &mut self.records);
        self.definitions += self.records.len() - before;
        self.index.insert(id, Vec::new());
    }

    /// Adds a message on a channel that this chunk defines.
    pub(crate) fn push(&mut self, message: RawMessage<'_>) {
        let offset = self.records.len() as u64;
        let first = self.index.values().all(Vec::is_empty);
        self.start = if first {
            message.log_time
        } else {
            self.start.min(message.log_time)
        };
        self.end = self.end.max(message.log_time);
        self.index
            .entry(message.channel)
            .or_default()
            .push((message.log_time, offset));
        record(&mut self.records, op::MESSAGE, |bytes| {
            bytes.put_u16(message.channel);
            bytes.put_u32(message.sequence);
            bytes.put_u64(message.log_time);
            bytes.put_u64(message.publish_time);
            bytes.extend_from_slice(message.data);
        });
    }

    /// Appends the chunk and its message indexes to `bytes` and clears the chunk.
    pub(crate) fn finish(&mut self, compression: Compression, bytes: &mut Vec<u8>) -> ChunkLayout {
        let base = bytes.len();
        let mut compressed = 0;
        record(bytes, op::CHUNK, |bytes| {
            bytes.put_u64(self.start);
            bytes.put_u64(self.end);
            bytes.put_u64(self.records.len() as u64);
            bytes.put_u32(crc32fast::hash(&self.records));
            bytes.put_str(compression.mcap_name());
            let size_at = bytes.len();
            bytes.put_u64(0);
            compression.compress(&self.records, bytes);
            compressed = (bytes.len() - size_at - 8) as u64;
            bytes[size_at..size_at + 8].copy_from_slice(&compressed.to_le_bytes());
        });
        let length = bytes.len() - base;
        let mut index_offsets = Vec::with_capacity(self.index.len());
        for (&channel, entries) in &self.index {
            index_offsets.push((channel, (bytes.len() - base) as u64));
            record(bytes, op::MESSAGE_INDEX, |bytes| {
                bytes.put_u16(channel);
                bytes.put_u32(crate::encode::length(16 * entries.len()));
                for &(time, offset) in entries {
                    bytes.put_u64(time);
                    bytes.put_u64(offset);
                }
            });
        }
        let layout = ChunkLayout {
            start: self.start,
            end: self.end,
            length: length as u64,
            index_offsets,
            index_length: (bytes.len() - base - length) as u64,
            compressed,
            uncompressed: self.records.len() as u64,
        };
        // clearing keeps the allocated buffer
        self.records.clear();
        self.index.clear();
        self.schemas.clear();
        self.definitions = 0;
        (self.start, self.end) = (0, 0);
        layout
    }
}

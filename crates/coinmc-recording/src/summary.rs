//! The summary section: indexes and statistics at the end of a file.

use crate::chunk::{ChunkLayout, RawChannel, RawSchema};
use crate::encode::{MAGIC, Put, length, op, record};

/// Everything written so far, as the summary section lists it.
#[derive(Debug, Default)]
pub(crate) struct Summary {
    chunks: Vec<(u64, ChunkLayout, &'static str)>,
    attachments: Vec<AttachmentIndex>,
    metadata: Vec<MetadataIndex>,
    messages: u64,
    /// First and last log time.
    times: Option<(u64, u64)>,
}

#[derive(Debug)]
pub(crate) struct AttachmentIndex {
    pub(crate) offset: u64,
    pub(crate) length: u64,
    pub(crate) log_time: u64,
    pub(crate) create_time: u64,
    pub(crate) data_size: u64,
    pub(crate) name: String,
    pub(crate) media_type: String,
}

#[derive(Debug)]
pub(crate) struct MetadataIndex {
    pub(crate) offset: u64,
    pub(crate) length: u64,
    pub(crate) name: String,
}

/// A channel that has messages, and how many.
pub(crate) struct UsedChannel<'a> {
    pub(crate) id: u16,
    pub(crate) channel: &'a RawChannel,
    pub(crate) messages: u64,
}

impl Summary {
    pub(crate) fn message(&mut self, log_time: u64) {
        self.messages += 1;
        let (start, end) = self.times.unwrap_or((log_time, log_time));
        self.times = Some((start.min(log_time), end.max(log_time)));
    }

    pub(crate) fn chunk(&mut self, offset: u64, layout: ChunkLayout, compression: &'static str) {
        self.chunks.push((offset, layout, compression));
    }

    pub(crate) fn attachment(&mut self, index: AttachmentIndex) {
        self.attachments.push(index);
    }

    pub(crate) fn metadata(&mut self, index: MetadataIndex) {
        self.metadata.push(index);
    }

    /// The end of the file from offset `start`: summary, summary offsets, footer and magic bytes.
    pub(crate) fn encode(
        &self,
        start: u64,
        schemas: &[(u16, &RawSchema)],
        channels: &[UsedChannel<'_>],
    ) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut groups = Vec::new();
        let mut group = |bytes: &mut Vec<u8>, opcode, fill: &mut dyn FnMut(&mut Vec<u8>)| {
            let from = bytes.len();
            fill(bytes);
            if bytes.len() > from {
                groups.push((opcode, start + from as u64, (bytes.len() - from) as u64));
            }
        };
        group(&mut bytes, op::SCHEMA, &mut |bytes| {
            for (id, schema) in schemas {
                schema.put(*id, bytes);
            }
        });
        group(&mut bytes, op::CHANNEL, &mut |bytes| {
            for used in channels {
                used.channel.put(used.id, bytes);
            }
        });
        group(&mut bytes, op::STATISTICS, &mut |bytes| {
            self.put_statistics(bytes, schemas.len(), channels);
        });
        group(&mut bytes, op::CHUNK_INDEX, &mut |bytes| {
            self.chunks
                .iter()
                .for_each(|(offset, layout, name)| put_chunk_index(bytes, *offset, layout, name));
        });
        group(&mut bytes, op::ATTACHMENT_INDEX, &mut |bytes| {
            self.attachments.iter().for_each(|index| index.put(bytes));
        });
        group(&mut bytes, op::METADATA_INDEX, &mut |bytes| {
            self.metadata.iter().for_each(|index| index.put(bytes));
        });
        let offsets = start + bytes.len() as u64;
        for (opcode, from, length) in groups {
            record(&mut bytes, op::SUMMARY_OFFSET, |bytes| {
                bytes.put_u8(opcode);
                bytes.put_u64(from);
                bytes.put_u64(length);
            });
        }
        // the checksum covers the footer up to the checksum itself
        bytes.put_u8(op::FOOTER);
        bytes.put_u64(20);
        bytes.put_u64(start);
        bytes.put_u64(offsets);
        let crc = crc32fast::hash(&bytes);
        bytes.put_u32(crc);
        bytes.extend_from_slice(&MAGIC);
        bytes
    }

    fn put_statistics(&self, bytes: &mut Vec<u8>, schemas: usize, channels: &[UsedChannel<'_>]) {
        let (start, end) = self.times.unwrap_or_default();
        record(bytes, op::STATISTICS, |bytes| {
            bytes.put_u64(self.messages);
            bytes.put_u16(u16::try_from(schemas).expect("ids have 16 bits"));
            bytes.put_u32(length(channels.len()));
            bytes.put_u32(length(self.attachments.len()));
            bytes.put_u32(length(self.metadata.len()));
            bytes.put_u32(length(self.chunks.len()));
            bytes.put_u64(start);
            bytes.put_u64(end);
            bytes.put_u32(length(10 * channels.len()));
            for used in channels {
                bytes.put_u16(used.id);
                bytes.put_u64(used.messages);
            }
        });
    }
}

fn put_chunk_index(bytes: &mut Vec<u8>, offset: u64, layout: &ChunkLayout, compression: &str) {
    record(bytes, op::CHUNK_INDEX, |bytes| {
        bytes.put_u64(layout.start);
        bytes.put_u64(layout.end);
        bytes.put_u64(offset);
        bytes.put_u64(layout.length);
        bytes.put_u32(length(10 * layout.index_offsets.len()));
        for &(channel, index_offset) in &layout.index_offsets {
            bytes.put_u16(channel);
            bytes.put_u64(offset + index_offset);
        }
        bytes.put_u64(layout.index_length);
        bytes.put_str(compression);
        bytes.put_u64(layout.compressed);
        bytes.put_u64(layout.uncompressed);
    });
}

impl AttachmentIndex {
    fn put(&self, bytes: &mut Vec<u8>) {
        record(bytes, op::ATTACHMENT_INDEX, |bytes| {
            bytes.put_u64(self.offset);
            bytes.put_u64(self.length);
            bytes.put_u64(self.log_time);
            bytes.put_u64(self.create_time);
            bytes.put_u64(self.data_size);
            bytes.put_str(&self.name);
            bytes.put_str(&self.media_type);
        });
    }
}

impl MetadataIndex {
    fn put(&self, bytes: &mut Vec<u8>) {
        record(bytes, op::METADATA_INDEX, |bytes| {
            bytes.put_u64(self.offset);
            bytes.put_u64(self.length);
            bytes.put_str(&self.name);
        });
    }
}

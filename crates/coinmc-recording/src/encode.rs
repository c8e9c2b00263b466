//! Encoding MCAP records (<https://mcap.dev/spec>): magic bytes, opcodes and fields.

use std::collections::BTreeMap;

/// First and last bytes of a file.
pub(crate) const MAGIC: [u8; 8] = *b"\x89MCAP0\r\n";

/// Bytes before a record's content: its opcode and its length.
pub(crate) const PREFIX: usize = 9;

/// Opcodes of records.
pub(crate) mod op {
    pub(crate) const HEADER: u8 = 0x01;
    pub(crate) const FOOTER: u8 = 0x02;
    pub(crate) const SCHEMA: u8 = 0x03;
    pub(crate) const CHANNEL: u8 = 0x04;
    pub(crate) const MESSAGE: u8 = 0x05;
    pub(crate) const CHUNK: u8 = 0x06;
    pub(crate) const MESSAGE_INDEX: u8 = 0x07;
    pub(crate) const CHUNK_INDEX: u8 = 0x08;
    pub(crate) const ATTACHMENT: u8 = 0x09;
    pub(crate) const ATTACHMENT_INDEX: u8 = 0x0a;
    pub(crate) const STATISTICS: u8 = 0x0b;
    pub(crate) const METADATA: u8 = 0x0c;
    pub(crate) const METADATA_INDEX: u8 = 0x0d;
    pub(crate) const SUMMARY_OFFSET: u8 = 0x0e;
    pub(crate) const DATA_END: u8 = 0x0f;
}

/// Appends encoded fields.
pub(crate) trait Put {
    fn put_u8(&mut self, x: u8);
    fn put_u16(&mut self, x: u16);
    fn put_u32(&mut self, x: u32);
    fn put_u64(&mut self, x: u64);
    /// The 32-bit length, then the text.
    fn put_str(&mut self, text: &str);
    /// The 32-bit length, then the bytes.
    fn put_bytes(&mut self, bytes: &[u8]);
    fn put_map(&mut self, map: &BTreeMap<String, String>);
}

impl Put for Vec<u8> {
    fn put_u8(&mut self, x: u8) {
        self.push(x);
    }

    fn put_u16(&mut self, x: u16) {
        self.extend_from_slice(&x.to_le_bytes());
    }

    fn put_u32(&mut self, x: u32) {
        self.extend_from_slice(&x.to_le_bytes());
    }

    fn put_u64(&mut self, x: u64) {
        self.extend_from_slice(&x.to_le_bytes());
    }

    fn put_str(&mut self, text: &str) {
        self.put_bytes(text.as_bytes());
    }

    fn put_bytes(&mut self, bytes: &[u8]) {
        self.put_u32(length(bytes.len()));
        self.extend_from_slice(bytes);
    }

    fn put_map(&mut self, map: &BTreeMap<String, String>) {
        let pairs = map.iter().map(|(key, value)| 8 + key.len() + value.len());
        self.put_u32(length(pairs.sum()));
        for (key, value) in map {
            self.put_str(key);
            self.put_str(value);
        }
    }
}

/// A 32-bit length. The writer rejects anything longer beforehand.
pub(crate) fn length(n: usize) -> u32 {
    u32::try_from(n).expect("the writer has checked that it fits")
}

/// Appends a record: its opcode, its length, and the content that `fill` appends.
pub(crate) fn record(bytes: &mut Vec<u8>, opcode: u8, fill: impl FnOnce(&mut Vec<u8>)) {
    bytes.put_u8(opcode);
    let length_at = bytes.len();
    bytes.put_u64(0);
    fill(bytes);
    let length = (bytes.len() - length_at - 8) as u64;
    bytes[length_at..length_at + 8].copy_from_slice(&length.to_le_bytes());
}

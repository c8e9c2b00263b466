//! Decoding the fields of records from untrusted bytes.

use std::collections::BTreeMap;

/// The unread fields of a record. Every read returns `None` if too few bytes are left.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Fields<'a> {
    bytes: &'a [u8],
}

impl<'a> Fields<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        Self { bytes }
    }

    /// The unread bytes.
    pub(crate) fn rest(self) -> &'a [u8] {
        self.bytes
    }

    pub(crate) fn take(&mut self, n: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.bytes.split_at_checked(n)?;
        self.bytes = rest;
        Some(taken)
    }

    fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (taken, rest) = self.bytes.split_first_chunk()?;
        self.bytes = rest;
        Some(*taken)
    }

    pub(crate) fn u8(&mut self) -> Option<u8> {
        self.array().map(|[x]| x)
    }

    pub(crate) fn u16(&mut self) -> Option<u16> {
        self.array().map(u16::from_le_bytes)
    }

    pub(crate) fn u32(&mut self) -> Option<u32> {
        self.array().map(u32::from_le_bytes)
    }

    pub(crate) fn u64(&mut self) -> Option<u64> {
        self.array().map(u64::from_le_bytes)
    }

    /// Bytes that follow their 32-bit length.
    pub(crate) fn bytes(&mut self) -> Option<&'a [u8]> {
        let length = self.u32()?;
        self.take(usize::try_from(length).ok()?)
    }

    pub(crate) fn str(&mut self) -> Option<&'a str> {
        str::from_utf8(self.bytes()?).ok()
    }

    pub(crate) fn map(&mut self) -> Option<BTreeMap<String, String>> {
        let mut pairs = Fields::new(self.bytes()?);
        let mut map = BTreeMap::new();
        while !pairs.bytes.is_empty() {
            map.insert(pairs.str()?.to_owned(), pairs.str()?.to_owned());
        }
        Some(map)
    }

    /// The next record: its opcode and content.
    pub(crate) fn record(&mut self) -> Option<(u8, &'a [u8])> {
        let opcode = self.u8()?;
        let length = self.u64()?;
        Some((opcode, self.take(usize::try_from(length).ok()?)?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::encode::{Put, record};

    #[test]
    fn encoded_fields_decode_to_the_same_values() {
        let map: BTreeMap<_, _> = [("a".to_owned(), "1".to_owned())].into();
        let mut bytes = Vec::new();
        record(&mut bytes, 7, |bytes| {
            bytes.put_u8(1);
            bytes.put_u16(2);
            bytes.put_u32(3);
            bytes.put_u64(4);
            bytes.put_str("five");
            bytes.put_map(&map);
        });
        let (kind, content) = Fields::new(&bytes).record().unwrap();
        let mut fields = Fields::new(content);
        assert_eq!(
            (kind, fields.u8(), fields.u16(), fields.u32(), fields.u64()),
            (7, Some(1), Some(2), Some(3), Some(4))
        );
        assert_eq!((fields.str(), fields.map()), (Some("five"), Some(map)));
        assert!(fields.rest().is_empty() && fields.u8().is_none());
    }

    #[test]
    fn a_length_beyond_the_end_gives_none() {
        assert_eq!(Fields::new(&[255, 255, 255, 255, 1]).str(), None);
        assert_eq!(Fields::new(&[1, 0, 0, 0, 255]).str(), None);
        assert_eq!(Fields::new(&[4, 0, 0, 0, 1, 0, 0, 0]).map(), None);
        let mut endless = vec![1];
        endless.put_u64(u64::MAX);
        assert_eq!(Fields::new(&endless).record(), None);
    }
}

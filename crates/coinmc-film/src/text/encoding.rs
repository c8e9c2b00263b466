//! Text encodings: UTF-8 with or without byte order mark, and Latin-1.

/// The encoding of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Encoding {
    /// UTF-8, as Tracker writes.
    #[default]
    Utf8,
    /// UTF-8 with a byte order mark, as spreadsheets save it.
    Utf8Mark,
    /// ISO 8859-1, assumed for everything that is not UTF-8.
    Latin1,
}

impl Encoding {
    /// The name in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Utf8 => "UTF-8",
            Self::Utf8Mark => "UTF-8 with byte order mark",
            Self::Latin1 => "Latin-1",
        }
    }
}

/// The byte order mark of UTF-8.
pub(super) const MARK: &[u8] = b"\xEF\xBB\xBF";

/// Decodes bytes; `None` for UTF-16 and binary data.
pub(super) fn decoded(bytes: &[u8]) -> Option<(String, Encoding)> {
    // UTF-16 contains zero bytes in either order; other text files do not
    if bytes.contains(&0) {
        return None;
    }
    let (bytes, encoding) = match bytes.strip_prefix(MARK) {
        Some(rest) => (rest, Encoding::Utf8Mark),
        None => (bytes, Encoding::Utf8),
    };
    Some(match std::str::from_utf8(bytes) {
        Ok(text) => (text.to_owned(), encoding),
        Err(_) => (
            bytes.iter().map(|b| char::from(*b)).collect(),
            Encoding::Latin1,
        ),
    })
}

/// Encodes text; characters that Latin-1 lacks become question marks.
pub(super) fn encoded(text: &str, encoding: Encoding) -> Vec<u8> {
    match encoding {
        Encoding::Utf8 => text.as_bytes().to_vec(),
        Encoding::Utf8Mark => [MARK, text.as_bytes()].concat(),
        Encoding::Latin1 => text
            .chars()
            .map(|c| u8::try_from(u32::from(c)).unwrap_or(b'?'))
            .collect(),
    }
}

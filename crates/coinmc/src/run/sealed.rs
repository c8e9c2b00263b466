//! Short texts that end with a checksum of everything before it: tallies and integrals.

use super::damage::Damage;
use std::fmt::Write;

pub(super) const CHECKSUM: &str = "crc32 ";
/// Longest text, in bytes; longer ones are not read.
pub(super) const MAX_BYTES: usize = 2048;

/// Appends the checksum.
pub(super) fn seal(mut text: String) -> String {
    let checksum = crc32fast::hash(text.as_bytes());
    writeln!(text, "{CHECKSUM}{checksum:08x}").expect("a String takes all text");
    text
}

/// The text whose checksum is right, without the checksum. It is then as it was written; its
/// author is not known.
pub(super) fn unseal(bytes: &[u8]) -> Result<&str, Damage> {
    if bytes.len() > MAX_BYTES {
        return Err(Damage::TooLong);
    }
    let text = std::str::from_utf8(bytes).map_err(|_| Damage::Checksum)?;
    let (body, checksum) = text.rsplit_once(CHECKSUM).ok_or(Damage::Checksum)?;
    if checksum == format!("{:08x}\n", crc32fast::hash(body.as_bytes())) {
        Ok(body)
    } else {
        Err(Damage::Checksum)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A text of so many bytes, with its checksum.
    fn sealed(bytes: usize) -> String {
        let checksum = seal(String::new()).len();
        seal("a".repeat(bytes - checksum))
    }

    #[test]
    fn long_texts_are_not_read_even_if_their_checksum_is_right() {
        for bytes in [100, MAX_BYTES - 1, MAX_BYTES] {
            let text = sealed(bytes);
            assert_eq!(text.len(), bytes);
            let body = unseal(text.as_bytes()).expect("a text that is short enough");
            assert!(body.chars().all(|letter| letter == 'a'), "{bytes}");
        }
        for bytes in [MAX_BYTES + 1, MAX_BYTES + 2, 10 * MAX_BYTES] {
            let text = sealed(bytes);
            assert!(matches!(unseal(text.as_bytes()), Err(Damage::TooLong)));
        }
    }
}

//! A file of sealed texts, one after the other, read block by block.

use super::sealed::{CHECKSUM, MAX_BYTES};
use std::io::{self, BufRead, Read};
use std::ops::Range;

/// How every text begins.
const TITLE: &[u8] = b"coinmc ";

/// A stretch of the file: a text from its title to its checksum, or what cannot be one.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Block {
    /// Where it is.
    pub(super) place: Range<u64>,
    /// Its bytes; of what is too long only the first.
    pub(super) bytes: Vec<u8>,
    /// It ends with a line that begins like a checksum. Only the last block of a file that was being
    /// written does not.
    pub(super) is_closed: bool,
}

/// Reads a file block by block, without holding more than one of them.
#[derive(Debug)]
pub(super) struct Blocks<R> {
    file: R,
    at: u64,
    /// The first line of the next block, if it was read.
    ahead: Vec<u8>,
}

impl<R: BufRead> Blocks<R> {
    pub(super) fn new(file: R) -> Self {
        Self {
            file,
            at: 0,
            ahead: Vec::new(),
        }
    }

    /// A line with its line feed, or a stretch of one that is too long; empty at the end.
    fn line(&mut self) -> io::Result<Vec<u8>> {
        if !self.ahead.is_empty() {
            return Ok(std::mem::take(&mut self.ahead));
        }
        let mut line = Vec::new();
        let most = MAX_BYTES as u64 + 1;
        (&mut self.file).take(most).read_until(b'\n', &mut line)?;
        Ok(line)
    }

    fn block(&mut self) -> io::Result<Option<Block>> {
        let begin = self.at;
        let (mut bytes, mut is_closed) = (Vec::new(), false);
        while !is_closed {
            let line = self.line()?;
            if line.is_empty() || (line.starts_with(TITLE) && self.at > begin) {
                self.ahead = line;
                break;
            }
            self.at += line.len() as u64;
            is_closed = line.starts_with(CHECKSUM.as_bytes()) && line.ends_with(b"\n");
            if bytes.len() <= MAX_BYTES {
                bytes.extend(line);
            }
        }
        // another begins: this one will never be closed
        is_closed |= !self.ahead.is_empty();
        let place = begin..self.at;
        Ok((!place.is_empty()).then_some(Block {
            place,
            bytes,
            is_closed,
        }))
    }
}

impl<R: BufRead> Iterator for Blocks<R> {
    type Item = io::Result<Block>;

    fn next(&mut self) -> Option<io::Result<Block>> {
        self.block().transpose()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn blocks(text: &[u8]) -> Vec<(Range<u64>, bool)> {
        let blocks = Blocks::new(text).map(Result::unwrap);
        blocks.map(|block| (block.place, block.is_closed)).collect()
    }

    #[test]
    fn a_file_falls_into_blocks_whatever_it_holds() {
        let good = b"coinmc a\nx\ncrc32 0\n";
        assert_eq!(blocks(b""), []);
        assert_eq!(blocks(good), [(0..19, true)]);
        assert_eq!(blocks(&good.repeat(2)), [(0..19, true), (19..38, true)]);
        // what a kill leaves
        let torn = [&good[..], b"coinmc a\nx\ncrc"].concat();
        assert_eq!(blocks(&torn), [(0..19, true), (19..33, false)]);
        // what was damaged before others were added
        let torn = [b"coinmc a\nx\ncrc\n", &good[..]].concat();
        assert_eq!(blocks(&torn), [(0..15, true), (15..34, true)]);
        let long = [&vec![b'z'; 3 * MAX_BYTES][..], b"\n", &good[..]].concat();
        let end = 3 * MAX_BYTES as u64 + 1;
        assert_eq!(blocks(&long), [(0..end, true), (end..end + 19, true)]);
        let first = Blocks::new(&long[..]).next().unwrap().unwrap();
        assert!(first.bytes.len() <= 2 * (MAX_BYTES + 1));
    }
}

//! Random access to a damaged file.

use std::io::{self, BufReader, Read, Seek, SeekFrom};

/// Size of the read buffer, bytes.
const BUFFER: usize = 64 << 10;

/// An input of known length.
pub(super) struct Source<R> {
    input: BufReader<R>,
    position: u64,
    length: u64,
}

impl<R: Read + Seek> Source<R> {
    pub(super) fn new(mut input: R) -> io::Result<Self> {
        let length = input.seek(SeekFrom::End(0))?;
        input.seek(SeekFrom::Start(0))?;
        Ok(Self {
            input: BufReader::with_capacity(BUFFER, input),
            position: 0,
            length,
        })
    }

    pub(super) fn length(&self) -> u64 {
        self.length
    }

    /// Fills `bytes` from the offset `at`; `false` if the input ends before.
    pub(super) fn fill(&mut self, at: u64, bytes: &mut [u8]) -> io::Result<bool> {
        if at > self.length || bytes.len() as u64 > self.length - at {
            return Ok(false);
        }
        self.seek_to(at)?;
        self.input.read_exact(bytes)?;
        self.position += bytes.len() as u64;
        Ok(true)
    }

    /// `n` bytes from the offset `at`, or fewer if the input ends before.
    pub(super) fn read(&mut self, at: u64, n: u64) -> io::Result<Vec<u8>> {
        self.seek_to(at.min(self.length))?;
        let mut bytes = Vec::new();
        (&mut self.input).take(n).read_to_end(&mut bytes)?;
        self.position += bytes.len() as u64;
        Ok(bytes)
    }

    pub(super) fn u32(&mut self, at: u64) -> io::Result<Option<u32>> {
        let mut bytes = [0; 4];
        Ok(self
            .fill(at, &mut bytes)?
            .then(|| u32::from_le_bytes(bytes)))
    }

    pub(super) fn u64(&mut self, at: u64) -> io::Result<Option<u64>> {
        let mut bytes = [0; 8];
        Ok(self
            .fill(at, &mut bytes)?
            .then(|| u64::from_le_bytes(bytes)))
    }

    /// Short jumps stay within the buffer.
    fn seek_to(&mut self, at: u64) -> io::Result<()> {
        let jump = i128::from(at) - i128::from(self.position);
        match i64::try_from(jump) {
            Ok(jump) => self.input.seek_relative(jump)?,
            Err(_) => drop(self.input.seek(SeekFrom::Start(at))?),
        }
        self.position = at;
        Ok(())
    }
}

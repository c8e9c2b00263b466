//! A damaged file, read here and there.

use std::io::{self, BufReader, Read, Seek, SeekFrom};

/// Bytes read at a time.
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

    /// Reads `bytes.len()` bytes at `at`; whether there are as many.
    pub(super) fn fill(&mut self, at: u64, bytes: &mut [u8]) -> io::Result<bool> {
        if at > self.length || bytes.len() as u64 > self.length - at {
            return Ok(false);
        }
        self.go_to(at)?;
        self.input.read_exact(bytes)?;
        self.position += bytes.len() as u64;
        Ok(true)
    }

    /// `n` bytes at `at`, or as many as there are.
    pub(super) fn read(&mut self, at: u64, n: u64) -> io::Result<Vec<u8>> {
        self.go_to(at.min(self.length))?;
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

    /// Near jumps stay within the buffer.
    fn go_to(&mut self, at: u64) -> io::Result<()> {
        let jump = i128::from(at) - i128::from(self.position);
        match i64::try_from(jump) {
            Ok(jump) => self.input.seek_relative(jump)?,
            Err(_) => drop(self.input.seek(SeekFrom::Start(at))?),
        }
        self.position = at;
        Ok(())
    }
}

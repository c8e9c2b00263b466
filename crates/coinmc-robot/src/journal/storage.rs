//! What a journal lies on: a file, or, in tests, a disk that fails.

use std::fmt::Debug;
use std::fs::File;
use std::io::{self, Read, Seek, Write};

/// A journal's bytes, of which those written before a [`Storage::sync`] outlast a loss of power.
pub trait Storage: Read + Write + Seek + Debug + Send {
    /// Returns once everything written is on the disk.
    ///
    /// # Errors
    /// System errors. What was written is then on the disk or not, even if it can be read back.
    fn sync(&mut self) -> io::Result<()>;

    /// Cuts off what lies after this length, bytes, on the disk, too.
    ///
    /// # Errors
    /// System errors.
    fn cut(&mut self, length: u64) -> io::Result<()>;
}

impl Storage for File {
    fn sync(&mut self) -> io::Result<()> {
        self.sync_data()
    }

    fn cut(&mut self, length: u64) -> io::Result<()> {
        self.set_len(length)?;
        self.sync_all()
    }
}

//! Where a recording goes.

use std::fs::File;
use std::io::{self, BufWriter, Write};

/// A writer that can bring what it was given to a place that lasts.
pub trait Sink: Write {
    /// Everything written so far survives a crash of the process and, where the system can, of the
    /// machine.
    ///
    /// # Errors
    /// The system's.
    fn sync(&mut self) -> io::Result<()>;
}

impl Sink for File {
    fn sync(&mut self) -> io::Result<()> {
        self.sync_data()
    }
}

impl<S: Sink> Sink for BufWriter<S> {
    fn sync(&mut self) -> io::Result<()> {
        self.flush()?;
        self.get_mut().sync()
    }
}

/// A writer that nothing needs to last of before it is finished: memory, a file that is renamed
/// into place.
#[derive(Debug)]
pub struct Passing<W>(pub W);

impl<W: Write> Write for Passing<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.write(bytes)
    }

    fn write_all(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.0.write_all(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

impl<W: Write> Sink for Passing<W> {
    fn sync(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

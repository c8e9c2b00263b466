//! Output streams of recordings.

use std::fs::File;
use std::io::{self, BufWriter, Write};

/// A writer that can make its data durable.
pub trait Sink: Write {
    /// Makes everything written so far survive a crash of the process and, where the system
    /// supports it, a loss of power.
    ///
    /// # Errors
    /// System errors.
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

/// A writer whose data need not be durable before it is finished, such as memory or a file that is
/// moved into place at the end: syncing only flushes it.
#[derive(Debug)]
pub struct Unsynced<W>(pub W);

impl<W: Write> Write for Unsynced<W> {
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

impl<W: Write> Sink for Unsynced<W> {
    fn sync(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

//! What a connection goes over: a serial port, or, in tests, a line that fails.

use super::{PortError, open};
use serial2::SerialPort;
use std::fmt::Debug;
use std::io::{self, Read, Write};
use std::path::PathBuf;
use std::time::Duration;

/// An open line to a robot.
pub trait Line: Read + Write + Debug + Send {
    /// How long a read waits for the first byte; then it is an error of the kind
    /// [`TimedOut`](io::ErrorKind::TimedOut).
    ///
    /// # Errors
    /// System errors.
    fn set_patience(&mut self, patience: Duration) -> io::Result<()>;
}

/// Opens the line, and opens it again when it was lost.
pub trait Opener: Debug + Send {
    /// Opens it for this process alone.
    ///
    /// # Errors
    /// [`PortError`]
    fn open(&mut self) -> Result<Box<dyn Line>, PortError>;
}

impl Line for SerialPort {
    fn set_patience(&mut self, patience: Duration) -> io::Result<()> {
        self.set_read_timeout(patience)
    }
}

/// A serial port by its path.
#[derive(Debug)]
pub(super) struct Serial(pub(super) PathBuf);

impl Opener for Serial {
    fn open(&mut self) -> Result<Box<dyn Line>, PortError> {
        open(&self.0).map(|port| Box::new(port) as Box<dyn Line>)
    }
}

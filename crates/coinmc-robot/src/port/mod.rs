//! Serial ports: listing them by stable names, and opening one exclusively.

mod connection;
mod line;
mod list;

pub use connection::{Connection, ConnectionError, LinkEvent, RequestOutcome};
pub use line::{Line, Opener};
pub use list::{PortEntry, ports};

use crate::lock::lock;
use rustix::termios::{ControlModes, OptionalActions, ioctl_tiocexcl, tcgetattr, tcsetattr};
use serial2::SerialPort;
use std::fs;
use std::io;
use std::os::unix::fs::FileTypeExt;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Baud rate of the link, bits per second.
const BAUD: u32 = 115_200;

/// Why a port cannot be used.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum PortError {
    /// There is no port of this name.
    #[error("there is no port {}: is the robot plugged in? `coinmc robot ports` lists all ports", path.display())]
    Missing {
        /// The port.
        path: PathBuf,
    },
    /// Another program holds it.
    #[error("{} is in use by another program: only one can use a robot at a time. End the other one first", path.display())]
    Busy {
        /// The port.
        path: PathBuf,
    },
    /// The user has no permission.
    #[error("no permission to use {}: join the group that owns it (on most systems `dialout`) and log in again", path.display())]
    Forbidden {
        /// The port.
        path: PathBuf,
    },
    /// Another system error.
    #[error("cannot use {} as a serial port: {error}", path.display())]
    Io {
        /// The port.
        path: PathBuf,
        /// The system's error.
        error: io::Error,
    },
}

/// Opens a port exclusively for this process.
fn open(path: &Path) -> Result<SerialPort, PortError> {
    let sort = |error: io::Error| sorted(path, error);
    // a named pipe would wait for its other end for ever
    if !fs::metadata(path)
        .map_err(sort)?
        .file_type()
        .is_char_device()
    {
        return Err(sort(io::Error::other("it is not a device")));
    }
    let port = SerialPort::open(path, BAUD).map_err(sort)?;
    // Neither is enough alone: the exclusive mode does not apply to the superuser, and the lock
    // does not apply to programs that take none. The system releases both when the process ends.
    lock(&port).map_err(sort)?;
    ioctl_tiocexcl(&port).map_err(|error| sorted(path, error.into()))?;
    keep_ready(&port).map_err(sort)?;
    // Discard what an earlier host left unread.
    port.discard_buffers().map_err(sort)?;
    Ok(port)
}

/// Leaves the line "data terminal ready" as it is when the port is closed. An Arduino Uno resets itself
/// when the line rises: once, when the port is opened first, but not again for every new host.
fn keep_ready(port: &SerialPort) -> io::Result<()> {
    let mut settings = tcgetattr(port)?;
    settings.control_modes.remove(ControlModes::HUPCL);
    Ok(tcsetattr(port, OptionalActions::Now, &settings)?)
}

fn sorted(path: &Path, error: io::Error) -> PortError {
    let path = path.to_owned();
    match error.kind() {
        io::ErrorKind::NotFound => PortError::Missing { path },
        io::ErrorKind::ResourceBusy | io::ErrorKind::WouldBlock => PortError::Busy { path },
        io::ErrorKind::PermissionDenied => PortError::Forbidden { path },
        _ => PortError::Io { path, error },
    }
}

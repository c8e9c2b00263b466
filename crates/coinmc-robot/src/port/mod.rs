//! Serial ports: listing them by stable names, and opening one exclusively.

mod connection;
mod list;

pub use connection::{Connection, ConnectionError, LinkEvent, RequestOutcome};
pub use list::{PortEntry, ports};

use crate::lock::lock;
use rustix::termios::ioctl_tiocexcl;
use serial2::SerialPort;
use std::io;
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
    let port = SerialPort::open(path, BAUD).map_err(sort)?;
    // Neither is enough alone: the exclusive mode does not apply to the superuser, and the lock
    // does not apply to programs that take none. The system releases both when the process ends.
    lock(&port).map_err(sort)?;
    ioctl_tiocexcl(&port).map_err(|error| sorted(path, error.into()))?;
    // Discard what an earlier host left unread.
    port.discard_buffers().map_err(sort)?;
    Ok(port)
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

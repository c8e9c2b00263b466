//! Serial ports: finding them by a name that stays, and holding one alone.

mod connection;
mod list;

pub use connection::{Answer, Connection, ConnectionError, LinkEvent};
pub use list::{PortEntry, ports};

use crate::lock::lock;
use rustix::termios::ioctl_tiocexcl;
use serial2::SerialPort;
use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Bits a second of the link.
const BAUD: u32 = 115_200;

/// Why a port cannot be used.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum PortError {
    /// There is none of this name.
    #[error("there is no port {}: is the robot plugged in? `coinmc robot ports` lists the ports that are there", path.display())]
    Missing {
        /// The port.
        path: PathBuf,
    },
    /// Another program holds it.
    #[error("{} is in use by another program: only one may talk to a robot. End the other one first", path.display())]
    Busy {
        /// The port.
        path: PathBuf,
    },
    /// This user may not.
    #[error("no permission to use {}: join the group that owns it (on most systems `dialout`) and log in again", path.display())]
    Forbidden {
        /// The port.
        path: PathBuf,
    },
    /// The system refuses otherwise.
    #[error("cannot use {} as a serial port: {error}", path.display())]
    Io {
        /// The port.
        path: PathBuf,
        /// What the system said.
        error: io::Error,
    },
}

/// Opens a port for this process alone.
fn open(path: &Path) -> Result<SerialPort, PortError> {
    let sort = |error: io::Error| sorted(path, error);
    let port = SerialPort::open(path, BAUD).map_err(sort)?;
    // Twice, since neither is enough: the exclusive mode does not bind the superuser, and the lock
    // does not bind programs that take none. Both end with the process, however it ends.
    lock(&port).map_err(sort)?;
    ioctl_tiocexcl(&port).map_err(|error| sorted(path, error.into()))?;
    // What an earlier host left unread is none of ours.
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

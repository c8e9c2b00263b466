//! The simulated robot's end of a pseudo-terminal.

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::{OFlags, fcntl_getfl, fcntl_setfl};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{OptionalActions, tcgetattr, tcsetattr};
use std::ffi::OsString;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Read, Write};
use std::os::unix::ffi::OsStringExt;
use std::os::unix::fs::{OpenOptionsExt, symlink};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// A pseudo-terminal; to a host, closing it looks like unplugging the robot.
#[derive(Debug)]
pub(super) struct Pty {
    master: File,
    /// Kept open so that reading does not fail while there is no host.
    _slave: File,
    path: PathBuf,
}

impl Pty {
    pub(super) fn open() -> io::Result<Self> {
        let master = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC)?;
        grantpt(&master)?;
        unlockpt(&master)?;
        let path = PathBuf::from(OsString::from_vec(
            ptsname(&master, Vec::new())?.into_bytes(),
        ));
        let slave = OpenOptions::new()
            .read(true)
            .write(true)
            .custom_flags(OFlags::NOCTTY.bits().cast_signed())
            .open(&path)?;
        let mut settings = tcgetattr(&slave)?;
        settings.make_raw();
        tcsetattr(&slave, OptionalActions::Now, &settings)?;
        fcntl_setfl(&master, fcntl_getfl(&master)? | OFlags::NONBLOCK)?;
        Ok(Self {
            master: master.into(),
            _slave: slave,
            path,
        })
    }

    /// The device that a host opens.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Reads bytes that have arrived, waiting at most this time; 0 if there are none.
    pub(super) fn read(&mut self, bytes: &mut [u8], wait: Duration) -> io::Result<usize> {
        let wait = Timespec {
            tv_sec: wait.as_secs().try_into().unwrap_or(1),
            tv_nsec: wait.subsec_nanos().into(),
        };
        let mut fds = [PollFd::new(&self.master, PollFlags::IN)];
        match poll(&mut fds, Some(&wait)) {
            Ok(0) | Err(rustix::io::Errno::INTR) => return Ok(0),
            Ok(_) => {}
            Err(error) => return Err(error.into()),
        }
        match self.master.read(bytes) {
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => Ok(0),
            read => read,
        }
    }

    /// Sends what fits; a host that does not read loses the rest, as on a real line.
    pub(super) fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        match self.master.write(bytes) {
            Err(error) if error.kind() != io::ErrorKind::WouldBlock => Err(error),
            _ => Ok(()),
        }
    }
}

/// A symbolic link whose name stays the same when the robot is unplugged and plugged in again, like
/// those in `/dev/serial/by-id` for real robots. Removed when dropped.
#[derive(Debug)]
pub(super) struct StableName(PathBuf);

impl StableName {
    /// Claims a name that is free or a link left over from another simulation.
    pub(super) fn claim(path: &Path) -> io::Result<Self> {
        match fs::symlink_metadata(path) {
            Ok(found) if !found.file_type().is_symlink() => {
                Err(io::ErrorKind::AlreadyExists.into())
            }
            _ => Ok(Self(path.to_owned())),
        }
    }

    /// Points the link to a device.
    pub(super) fn point_to(&self, device: &Path) -> io::Result<()> {
        self.remove();
        symlink(device, &self.0)
    }

    /// Removes the link: the robot is unplugged.
    pub(super) fn remove(&self) {
        // if it stays, it leads nowhere, and the next simulation claims it
        let _ = fs::remove_file(&self.0);
    }
}

impl Drop for StableName {
    fn drop(&mut self) {
        self.remove();
    }
}

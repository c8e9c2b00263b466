//! Locks on open files, which the system releases when the process ends for any reason.

use rustix::fs::{FlockOperation, flock};
use rustix::io::Errno;
use std::io;
use std::os::fd::AsFd;
use std::thread;
use std::time::Duration;

/// Attempts to take a held lock, and the pause between them: a third of a second in all.
const ATTEMPTS: u32 = 16;
const PAUSE: Duration = Duration::from_millis(20);

/// Locks a file exclusively for this process.
///
/// While a process starts another one, the new process briefly has a copy of all open files, and a
/// lock that was released meanwhile is still held by that copy. Therefore a held lock is tried
/// again. On file systems without locks this succeeds.
///
/// # Errors
/// [`io::ErrorKind::WouldBlock`] if another process holds the lock; other system errors.
pub(crate) fn lock(file: &impl AsFd) -> io::Result<()> {
    let mut left = ATTEMPTS;
    loop {
        match flock(file, FlockOperation::NonBlockingLockExclusive) {
            Ok(()) | Err(Errno::OPNOTSUPP) => return Ok(()),
            Err(Errno::WOULDBLOCK) if left > 0 => left -= 1,
            Err(error) => return Err(error.into()),
        }
        thread::sleep(PAUSE);
    }
}

//! Locks on open files, which end with their process however it ends.

use rustix::fs::{FlockOperation, flock};
use rustix::io::Errno;
use std::io;
use std::os::fd::AsFd;
use std::thread;
use std::time::Duration;

/// How often, and how far apart, a held lock is tried again: a third of a second in all.
const ATTEMPTS: u32 = 16;
const PAUSE: Duration = Duration::from_millis(20);

/// Locks a file for this process alone.
///
/// A process that another one is just starting holds a copy of its open files until it runs its own
/// program; a lock that was let go meanwhile is still held by that copy, for a moment: so a held
/// lock is tried again. Where files know no locks this succeeds.
///
/// # Errors
/// [`io::ErrorKind::WouldBlock`] if another process holds it; others of the system.
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

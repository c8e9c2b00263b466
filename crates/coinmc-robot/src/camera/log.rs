//! What the camera says on its standard error: a file of bounded size, and the last of it for messages.

use crate::files::open_to_append;
use std::collections::VecDeque;
use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::PathBuf;
use std::process::ChildStderr;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

/// Greatest size of the file. One older file of this size is kept beside it.
const MAX_BYTES: u64 = 1 << 20;
/// Bytes kept for messages.
const TAIL: usize = 300;

/// The log of a camera that may be started several times.
#[derive(Debug, Clone)]
pub(super) struct Log(Arc<Mutex<Inner>>);

#[derive(Debug)]
struct Inner {
    path: Option<PathBuf>,
    file: Option<File>,
    length: u64,
    tail: VecDeque<u8>,
}

impl Log {
    /// A log in a file, or only in memory.
    ///
    /// # Errors
    /// System errors; also if the file is a symbolic link or not a regular file.
    pub(super) fn open(path: Option<PathBuf>) -> io::Result<Self> {
        let mut inner = Inner {
            path,
            file: None,
            length: 0,
            tail: VecDeque::new(),
        };
        inner.open()?;
        Ok(Self(Arc::new(Mutex::new(inner))))
    }

    /// Logs everything from a process until it ends.
    pub(super) fn follow(&self, mut errors: ChildStderr) {
        let log = self.clone();
        thread::spawn(move || {
            let mut bytes = [0; 4096];
            while let Ok(length @ 1..) = errors.read(&mut bytes) {
                log.lock().add(&bytes[..length]);
            }
        });
    }

    /// The last line or lines, as far as they are kept; empty if it has said nothing.
    pub(super) fn last_words(&self) -> String {
        let inner = self.lock();
        let bytes: Vec<u8> = inner.tail.iter().copied().collect();
        String::from_utf8_lossy(&bytes).trim().to_owned()
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Inner> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Inner {
    fn open(&mut self) -> io::Result<()> {
        if let Some(path) = &self.path {
            let file = open_to_append(path)?;
            self.length = file.metadata()?.len();
            self.file = Some(file);
        }
        Ok(())
    }

    fn add(&mut self, bytes: &[u8]) {
        self.tail.extend(bytes);
        let excess = self.tail.len().saturating_sub(TAIL);
        self.tail.drain(..excess);
        if self.length > MAX_BYTES {
            self.rotate();
        }
        // a log that cannot be written must not stop the experiment
        if let Some(file) = &mut self.file
            && file.write_all(bytes).is_ok()
        {
            self.length += bytes.len() as u64;
        }
    }

    /// Moves the file aside and begins another one.
    fn rotate(&mut self) {
        self.file = None;
        let Some(path) = &self.path else { return };
        let mut older = path.clone().into_os_string();
        older.push(".1");
        if fs::rename(path, older).is_ok() {
            let _ = self.open();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_log_stays_small_and_keeps_the_last_words() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("camera.log");
        let log = Log::open(Some(path.clone())).unwrap();
        let line = [b"chatter ".repeat(100), b"\n".to_vec()].concat();
        for _ in 0..10_000 {
            log.lock().add(&line);
        }
        log.lock().add(b"no camera at /dev/video0\n");
        let size = |name: &str| fs::metadata(dir.path().join(name)).unwrap().len();
        assert!(size("camera.log") <= MAX_BYTES + 4096);
        assert!(size("camera.log.1") <= MAX_BYTES + 4096);
        assert!(log.last_words().ends_with("no camera at /dev/video0"));
        assert!(log.last_words().len() <= TAIL);
    }
}

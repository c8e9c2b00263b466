//! A disk that fails: what is written lies in the system's memory until it is synced, and any call may
//! fail, write only a part, or be the last of its process.
#![allow(missing_docs, unreachable_pub)]

use coinmc_robot::journal::Storage;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::ops::Range;
use std::sync::{Arc, Mutex};

/// How a call fails.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Failure {
    /// An error; a sync that fails leaves what was written readable, but never tries again.
    Error,
    Full,
    /// Writes only a part.
    Short,
    /// A signal came first; the call can be made again.
    Interrupted,
    /// The process is killed: nothing that it does from here on happens.
    Kill,
}

#[derive(Debug, Default)]
struct Platter {
    /// What is read: the system's memory.
    cache: Vec<u8>,
    /// What a loss of power leaves.
    durable: Vec<u8>,
    /// Parts of the cache that the next sync writes.
    dirty: Vec<Range<usize>>,
    /// Calls so far, and which of them fail.
    calls: u32,
    failures: Vec<(u32, Failure)>,
    killed: bool,
    injected: u32,
}

/// The disk.
#[derive(Debug, Clone, Default)]
pub struct Disk(Arc<Mutex<Platter>>);

/// A file open on it.
#[derive(Debug)]
pub struct Handle {
    disk: Disk,
    at: usize,
}

impl Disk {
    /// Opens its file; these calls fail, counted from now on.
    pub fn open(&self, failures: &[(u32, Failure)]) -> Handle {
        let mut platter = self.0.lock().unwrap();
        platter.calls = 0;
        platter.failures = failures.to_vec();
        platter.killed = false;
        drop(platter);
        Handle {
            disk: self.clone(),
            at: 0,
        }
    }

    /// The power fails; of what was not synced, the first part of each write may have reached the disk.
    pub fn lose_power(&self, part: usize) {
        let mut platter = self.0.lock().unwrap();
        let dirty = std::mem::take(&mut platter.dirty);
        for range in dirty {
            let end = range.end.min(range.start + part);
            platter.reach(range.start..end);
        }
        let Platter { cache, durable, .. } = &mut *platter;
        cache.clone_from(durable);
    }

    pub fn content(&self) -> Vec<u8> {
        self.0.lock().unwrap().cache.clone()
    }

    /// Failures that have happened.
    pub fn injected(&self) -> u32 {
        self.0.lock().unwrap().injected
    }
}

impl Platter {
    /// Counts a call; how it fails.
    fn call(&mut self) -> io::Result<Option<Failure>> {
        self.calls += 1;
        let calls = self.calls;
        let failure = self.failures.iter().find(|(at, _)| *at == calls);
        let failure = failure.map(|(_, failure)| *failure);
        self.injected += u32::from(failure.is_some());
        self.killed |= failure == Some(Failure::Kill);
        match failure {
            _ if self.killed => Err(io::Error::other("killed")),
            Some(Failure::Error) => Err(io::Error::other("an error of the disk")),
            Some(Failure::Full) => Err(io::ErrorKind::StorageFull.into()),
            Some(Failure::Interrupted) => Err(io::ErrorKind::Interrupted.into()),
            other => Ok(other),
        }
    }

    /// A part of the cache reaches the disk.
    fn reach(&mut self, range: Range<usize>) {
        let range = range.start.min(self.cache.len())..range.end.min(self.cache.len());
        if self.durable.len() < range.end {
            // what lies between was lost, and reads as zeros
            self.durable.resize(range.end, 0);
        }
        let part = self.cache[range.clone()].to_vec();
        self.durable[range].copy_from_slice(&part);
    }
}

impl Read for Handle {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let mut platter = self.disk.0.lock().unwrap();
        let short = platter.call()? == Some(Failure::Short);
        let left = platter.cache.get(self.at..).unwrap_or_default();
        let count = left.len().min(buffer.len());
        let count = if short { count.min(1) } else { count };
        buffer[..count].copy_from_slice(&left[..count]);
        self.at += count;
        Ok(count)
    }
}

impl Write for Handle {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let mut platter = self.disk.0.lock().unwrap();
        let short = platter.call()? == Some(Failure::Short);
        let count = if short {
            bytes.len().div_ceil(2)
        } else {
            bytes.len()
        };
        let range = self.at..self.at + count;
        if platter.cache.len() < range.end {
            platter.cache.resize(range.end, 0);
        }
        platter.cache[range.clone()].copy_from_slice(&bytes[..count]);
        platter.dirty.push(range);
        self.at += count;
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Seek for Handle {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.disk.0.lock().unwrap().call()?;
        match to {
            SeekFrom::Start(at) => self.at = usize::try_from(at).unwrap(),
            other => panic!("{other:?}"),
        }
        Ok(self.at as u64)
    }
}

impl Storage for Handle {
    fn sync(&mut self) -> io::Result<()> {
        let mut platter = self.disk.0.lock().unwrap();
        let called = platter.call();
        if !platter.killed {
            // those that could not be written are given up
            for range in std::mem::take(&mut platter.dirty) {
                if called.is_ok() {
                    platter.reach(range);
                }
            }
        }
        called.map(drop)
    }

    fn cut(&mut self, length: u64) -> io::Result<()> {
        let length = usize::try_from(length).unwrap();
        let mut platter = self.disk.0.lock().unwrap();
        platter.call()?;
        platter.cache.truncate(length);
        platter.durable.truncate(length);
        for range in &mut platter.dirty {
            range.start = range.start.min(length);
            range.end = range.end.min(length);
        }
        Ok(())
    }
}

//! The directory of tally files: reads finished chunks, adds new ones.

use super::chunk_result::{ChunkResult, whole};
use super::cut::Cut;
use super::damage::Damage;
use super::integral_file;
use super::replace::{self, Replacement, TEMPORARY};
use super::sealed::MAX_BYTES;
use super::tally_file;
use super::{Chunk, RunError};
use crate::plan::Plan;
use std::fs;
use std::io::Write;
use std::panic::resume_unwind;
use std::path::{Path, PathBuf};
use std::thread;

/// Appended to the name of a rejected file.
const REJECTED: &str = ".rejected";

/// The tally files of one run directory.
#[derive(Debug)]
pub(super) struct Tallies {
    path: PathBuf,
    plan_hash: String,
}

/// One of the directory's files. Files with names that this program never gives are ignored.
#[derive(Debug)]
pub(super) enum Entry {
    /// A finished chunk.
    Finished(Chunk, Box<ChunkResult>),
    /// A file that is rejected.
    Damaged(PathBuf, Damage),
    /// The temporary file of a killed run.
    Leftover(PathBuf),
}

impl Tallies {
    pub(super) const DIRECTORY: &'static str = "tallies";

    /// The tallies of the run directory `dir`.
    pub(super) fn of(dir: &Path, plan_hash: String) -> Self {
        Self {
            path: dir.join(Self::DIRECTORY),
            plan_hash,
        }
    }

    /// Visits every file once, in no particular order.
    pub(super) fn scan(
        &self,
        plan: &Plan,
        cut: &Cut,
        mut found: impl FnMut(Entry) -> Result<(), RunError>,
    ) -> Result<(), RunError> {
        let failed = |error| RunError::io("list", &self.path, error);
        for entry in fs::read_dir(&self.path).map_err(failed)? {
            let name = entry.map_err(failed)?.file_name();
            let Some(name) = name.to_str() else { continue };
            let path = self.path.join(name);
            if let Some((point, start)) = tally_file::parse_name(name) {
                let read = chunk_at(plan, cut, point, start)
                    .ok_or(Damage::NoSuchChunk)
                    .map(|chunk| self.read(&path, chunk, plan, cut.may_be_shorter()));
                found(match read {
                    Ok(entry) => entry?,
                    Err(damage) => Entry::Damaged(path, damage),
                })?;
            } else if name
                .strip_suffix(TEMPORARY)
                .and_then(tally_file::parse_name)
                .is_some()
            {
                found(Entry::Leftover(path))?;
            }
        }
        Ok(())
    }

    /// Reads the file of a chunk, or of one that begins like it and is shorter, if it may be.
    fn read(
        &self,
        path: &Path,
        mut chunk: Chunk,
        plan: &Plan,
        may_be_shorter: bool,
    ) -> Result<Entry, RunError> {
        if !replace::is_file(path) {
            return Ok(Entry::Damaged(path.to_owned(), Damage::NotAFile));
        }
        let bytes = replace::read_bounded(path, MAX_BYTES)
            .map_err(|error| RunError::io("read", path, error))?;
        let hash = &self.plan_hash;
        let result = bytes.ok_or(Damage::TooLong).and_then(|bytes| {
            if let Some(method) = plan.method(chunk.point) {
                let integral = integral_file::decode(&bytes, chunk.point, method, hash);
                return integral.map(ChunkResult::Integrated);
            }
            if may_be_shorter && let Some(end) = tally_file::end(&bytes) {
                chunk.tosses.end = chunk.tosses.end.min(end);
            }
            tally_file::decode(&bytes, &chunk, hash).map(ChunkResult::Tossed)
        });
        Ok(match result {
            Ok(result) => Entry::Finished(chunk, Box::new(result)),
            Err(damage) => Entry::Damaged(path.to_owned(), damage),
        })
    }

    /// Adds finished chunks durably: synced to the disk.
    pub(super) fn store(&self, batch: &[(Chunk, ChunkResult)]) -> Result<(), RunError> {
        let mut files = Vec::with_capacity(batch.len());
        for (chunk, result) in batch {
            let mut file = Replacement::begin(&self.path.join(tally_file::name(chunk)))?;
            let text = match result {
                ChunkResult::Tossed(tossed) => tally_file::encode(chunk, tossed, &self.plan_hash),
                ChunkResult::Integrated(integral) => {
                    integral_file::encode(chunk.point, integral, &self.plan_hash)
                }
            };
            let written = file.writer().write_all(text.as_bytes());
            written.map_err(|error| file.error(error))?;
            files.push(file);
        }
        sync_all(&mut files)?;
        files.into_iter().try_for_each(Replacement::finish)?;
        replace::sync_directory(&self.path)
    }

    /// Path of the file of the chunk of `point` that begins at toss `start`.
    pub(super) fn place(&self, point: usize, start: u64) -> PathBuf {
        self.path.join(tally_file::name(&Chunk {
            point,
            tosses: start..start,
        }))
    }
}

/// Syncs files on several threads: a thread that waits for the disk sleeps, and wakes late while
/// the workers keep all processors busy (64 files in sequence took 0.2 s). All content is handed to
/// the system before the first sync, as one sync often writes what the next would.
fn sync_all(files: &mut [Replacement]) -> Result<(), RunError> {
    const EACH: usize = 4;
    files.iter_mut().try_for_each(Replacement::hand_over)?;
    let sync = |files: &mut [Replacement]| files.iter_mut().try_for_each(Replacement::sync);
    if files.len() <= EACH {
        return sync(files);
    }
    thread::scope(|scope| {
        let mut threads = vec![];
        for files in files.chunks_mut(EACH) {
            let thread = thread::Builder::new().spawn_scoped(scope, move || sync(files));
            threads.push(thread.map_err(RunError::Thread)?);
        }
        let join = |thread: thread::ScopedJoinHandle<'_, _>| {
            thread.join().unwrap_or_else(|panic| resume_unwind(panic))
        };
        threads.into_iter().try_for_each(join)
    })
}

/// The chunk of a point that begins at toss `start`, if the plan has one.
fn chunk_at(plan: &Plan, cut: &Cut, point: usize, start: u64) -> Option<Chunk> {
    if point >= plan.points.len() {
        None
    } else if plan.integrates(point) {
        (start == 0).then(|| whole(point))
    } else if plan.makes_tosses(point) {
        cut.chunk_at(point, start)
    } else {
        None
    }
}

/// Renames a file that is rejected; returns its new name.
pub(super) fn reject(path: &Path) -> Result<PathBuf, RunError> {
    let mut name = path.as_os_str().to_owned();
    name.push(REJECTED);
    let rejected = PathBuf::from(name);
    fs::rename(path, &rejected).map_err(|error| RunError::io("rename", path, error))?;
    Ok(rejected)
}

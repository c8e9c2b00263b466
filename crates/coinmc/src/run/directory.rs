//! The run directory: locked by one process, which starts a run in it or resumes the one it holds.

use super::chunk_result::ChunkResult;
use super::cut::Cut;
use super::earlier::Earlier;
use super::extend::{self, Step};
use super::finished::Finished;
use super::made::{Made, Work};
use super::manifest::{self, Manifest};
use super::packed::Packed;
use super::provenance::{self, Log, Maker};
use super::replace::{self, Replacement};
use super::tallies::{Entry, Tallies};
use super::unfinished::{Beginnings, Unfinished};
use super::{Chunk, Part, ProgressSink, RunError};
use crate::plan::Plan;
use crate::results::{Results, write_csv};
#[cfg(feature = "parquet")]
use crate::results::{Table, write_tables};
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

/// The config as understood.
pub(super) const CONFIG: &str = "config.toml";
/// How often, and at what interval, a lock that somebody holds is tried again: a third of a second
/// in all.
const LOCK_ATTEMPTS: u32 = 16;
const LOCK_PAUSE: std::time::Duration = std::time::Duration::from_millis(20);
/// Locked while a process runs here; an empty file.
const LOCK: &str = "lock";
const CSV: &str = "results.csv";
const PARQUET: &str = "results.parquet";
/// Results of an unfinished run.
const PARTIAL: &str = "results.partial.csv";

/// A run directory whose lock this process holds.
#[derive(Debug)]
pub(super) struct RunDirectory {
    path: PathBuf,
    tallies: Tallies,
    unfinished: Unfinished,
    provenance: Log,
    plan_hash: String,
    /// The system releases it when the process ends, even by a kill.
    _lock: File,
}

impl RunDirectory {
    /// Starts a run in a new or empty directory, or resumes the run that the directory holds, or one of which
    /// the plan asks for more.
    pub(super) fn open(
        path: &Path,
        plan: &Plan,
        part: Part,
        build: &str,
        sink: &dyn ProgressSink,
    ) -> Result<Self, RunError> {
        let mut manifest = Manifest::new(plan, part);
        manifest.builds.insert(build.to_owned());
        extend(path, plan, &manifest, sink)?;
        Self::open_with(path, plan, manifest, sink)
    }

    /// [`open`](Self::open) with a manifest that may name several machines and builds.
    pub(super) fn open_with(
        path: &Path,
        plan: &Plan,
        mut ours: Manifest,
        sink: &dyn ProgressSink,
    ) -> Result<Self, RunError> {
        // check before anything is touched, and again under the lock
        must_be_usable(path, &ours)?;
        replace::create_directories(path)?;
        let lock = lock(path)?;
        let theirs = must_be_usable(path, &ours)?;

        for file in [manifest::FILE, CONFIG, CSV, PARQUET, PARTIAL] {
            replace::remove_leftover(&path.join(file))?;
        }
        if let Some(theirs) = &theirs {
            if let Some(warning) = theirs.warning_of_other_builds(&ours, path) {
                sink.warning(&warning);
            }
            ours.targets.extend(theirs.targets.iter().cloned());
            ours.builds.extend(theirs.builds.iter().cloned());
        }
        if theirs.as_ref() != Some(&ours) {
            ours.write(path)?;
        }
        for file in [
            Tallies::FILE,
            provenance::FILE,
            Unfinished::FILE,
            Earlier::FILE,
            Earlier::NEXT,
        ] {
            must_be_file(path, file)?;
        }
        for file in [
            Tallies::FILE,
            Tallies::REJECTED,
            Unfinished::FILE,
            Earlier::NEXT,
        ] {
            replace::remove_leftover(&path.join(file))?;
        }
        let extends = extend::settle(path, &ours.plan_hash)?;
        write_config(path, plan, extends, sink)?;
        replace::sync_directory(path)?;
        let tallies = Tallies::of(path, ours.plan_hash.clone());
        Ok(Self {
            path: path.to_owned(),
            unfinished: Unfinished::open(path, &tallies, plan)?,
            tallies,
            provenance: Log::of(path),
            plan_hash: ours.plan_hash,
            _lock: lock,
        })
    }

    pub(super) fn tallies(&self) -> &Tallies {
        &self.tallies
    }

    pub(super) fn provenance(&self) -> &Log {
        &self.provenance
    }

    /// Stores what one maker has done, in this order.
    pub(super) fn store(&self, maker: &Maker, batch: &[Work]) -> Result<(), RunError> {
        let finished = || {
            batch.iter().filter_map(|work| match work {
                Work::Finished(made) => Some(made),
                Work::Begun(..) => None,
            })
        };
        let begun = batch.iter().filter_map(|work| match work {
            Work::Finished(_) => None,
            Work::Begun(chunk, tossed) => Some((chunk, *tossed)),
        });
        // before the tallies: a chunk that counts has a maker
        let entries: Vec<_> = finished().map(Made::entry).collect();
        self.provenance.add(maker, &entries)?;
        self.tallies
            .store(finished().map(|made| (&made.chunk, &made.result)))?;
        let finished = finished().map(|made| &made.chunk);
        self.unfinished.update(&self.tallies, begun, finished)
    }

    /// What an earlier run has counted of chunks that it did not finish.
    pub(super) fn begun(&self) -> Beginnings {
        self.unfinished.begun()
    }

    /// The chunks that an earlier run finished. Cuts off what a killed run did not finish writing, and sets
    /// aside what is rejected.
    pub(super) fn finished(
        &self,
        plan: &Plan,
        sink: &dyn ProgressSink,
    ) -> Result<Finished, RunError> {
        let (mut finished, mut rejected, mut end) = (Vec::new(), Vec::new(), None);
        self.tallies.scan(plan, &Cut::new(plan), |entry| {
            match entry {
                Entry::Finished(chunk, result) => finished.push((chunk, Packed::from(&*result))),
                Entry::Torn(place) => end = Some(place.start),
                Entry::Damaged(damage, place) => {
                    sink.warning(&format!(
                        "{}, bytes {} to {}: a tally is rejected: {damage}. Its tosses are repeated; it \
                         is now in {}",
                        self.tallies.path().display(),
                        place.start,
                        place.end,
                        Tallies::REJECTED,
                    ));
                    rejected.push(place);
                }
            }
            Ok(())
        })?;
        if let Some(end) = end {
            self.tallies.cut_at(end)?;
        }
        if !rejected.is_empty() {
            self.tallies.put_in_order(&rejected, &[])?;
        }
        let earlier = Earlier::read(&self.path, plan, &self.plan_hash)?;
        Ok(Finished::new(finished).with_earlier(earlier))
    }

    /// Stores chunks of which a run that this one extends had all tosses.
    pub(super) fn take_over(&self, chunks: &[(Chunk, Packed)]) -> Result<(), RunError> {
        /// Tallies stored at once.
        const BATCH: usize = 4096;
        for batch in chunks.chunks(BATCH) {
            let results = batch.iter().map(|(_, packed)| ChunkResult::from(packed));
            let results: Vec<_> = results.collect();
            let chunks = batch.iter().map(|(chunk, _)| chunk);
            self.tallies.store(chunks.zip(&results))?;
        }
        Ok(())
    }

    /// Brings the tallies of a finished run, or part, into order, and sets aside those, given by point and
    /// first toss, that it did not need.
    pub(super) fn put_in_order(
        &self,
        unneeded: &[(usize, u64)],
        sink: &dyn ProgressSink,
    ) -> Result<(), RunError> {
        for (point, start) in unneeded {
            sink.warning(&format!(
                "{}: the tally of point {point} from toss {start} does not belong to this run; it is now in {}",
                self.tallies.path().display(),
                Tallies::REJECTED,
            ));
        }
        self.tallies.put_in_order(&[], unneeded)?;
        self.unfinished.clear()?;
        extend::forget(&self.path)
    }

    /// Writes the results of a finished run.
    pub(super) fn write_results(
        &self,
        results: &Results,
        sink: &dyn ProgressSink,
    ) -> Result<(), RunError> {
        replace::remove(&self.path.join(PARTIAL))?;
        self.write_tables(results, sink)?;
        for (_, kept) in extend::KEPT {
            replace::remove(&self.path.join(kept))?;
        }
        replace::sync_directory(&self.path)
    }

    #[cfg(feature = "parquet")]
    fn write_tables(&self, results: &Results, sink: &dyn ProgressSink) -> Result<(), RunError> {
        let mut parquet = Replacement::begin(&self.path.join(PARQUET))?;
        let mut csv = Replacement::begin(&self.path.join(CSV))?;
        // both at once, as each row takes a while to compute
        let written = write_tables(results, &mut parquet.writer(), &mut csv.writer());
        written.map_err(|(table, error)| match table {
            Table::Parquet => parquet.error(error),
            Table::Csv => csv.error(error),
        })?;
        self.finish(parquet, PARQUET, sink)?;
        self.finish(csv, CSV, sink)
    }

    #[cfg(not(feature = "parquet"))]
    fn write_tables(&self, results: &Results, sink: &dyn ProgressSink) -> Result<(), RunError> {
        let mut csv = Replacement::begin(&self.path.join(CSV))?;
        let written = write_csv(results, &mut csv.writer());
        written.map_err(|error| csv.error(error))?;
        self.finish(csv, CSV, sink)
    }

    /// Writes the results of an unfinished run.
    pub(super) fn write_partial(&self, results: &Results) -> Result<(), RunError> {
        let mut file = Replacement::begin(&self.path.join(PARTIAL))?;
        let written = write_csv(results, &mut file.writer());
        written.map_err(|error| file.error(error))?;
        file.finish()
    }

    fn finish(
        &self,
        file: Replacement,
        name: &str,
        sink: &dyn ProgressSink,
    ) -> Result<(), RunError> {
        if file.finish_if_new()? {
            sink.warning(&format!(
                "{} did not match the tallies and was replaced",
                self.path.join(name).display()
            ));
        }
        Ok(())
    }
}

/// Makes a directory that holds a run of which the plan asks for more a run of this plan; leaves any other alone.
fn extend(
    path: &Path,
    plan: &Plan,
    ours: &Manifest,
    sink: &dyn ProgressSink,
) -> Result<(), RunError> {
    let find = || {
        let theirs = Manifest::read(path).ok().flatten();
        let other = theirs.filter(|theirs| {
            theirs.plan_hash != ours.plan_hash && theirs.program_version == ours.program_version
        });
        let Some(theirs) = other else {
            return Ok(None);
        };
        let step = Step::find(path, plan, &theirs, ours)?;
        Ok(step.map(|step| (step, theirs)))
    };
    // check before anything is touched, and again under the lock
    if find()?.is_none() {
        return Ok(());
    }
    let _lock = lock(path)?;
    match find()? {
        Some((step, theirs)) => step.take(path, &theirs, ours, sink),
        None => Ok(()),
    }
}

/// Checks that `path` is absent, empty, just started or the run that `ours` describes, and returns
/// its manifest.
fn must_be_usable(path: &Path, ours: &Manifest) -> Result<Option<Manifest>, RunError> {
    let not_a_run = |found: String| RunError::NotARunDirectory {
        dir: path.to_owned(),
        found,
    };
    let entries = match fs::read_dir(path) {
        Ok(entries) => entries,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(error) if error.kind() == io::ErrorKind::NotADirectory => {
            return Err(not_a_run("a file, not a directory".to_owned()));
        }
        Err(error) => return Err(RunError::io("list", path, error)),
    };
    if let Some(theirs) = Manifest::read(path)? {
        theirs.must_match(ours, path)?;
        return Ok(Some(theirs));
    }
    for entry in entries {
        let name = entry
            .map_err(|error| RunError::io("list", path, error))?
            .file_name();
        // a run killed before it wrote its manifest leaves at most these files
        let just_begun = name.to_str().is_some_and(|name| {
            name == LOCK || name.strip_suffix(replace::TEMPORARY) == Some(manifest::FILE)
        });
        if !just_begun {
            return Err(not_a_run(format!(
                "{} and no {}",
                name.display(),
                manifest::FILE
            )));
        }
    }
    Ok(None)
}

/// Checks that what has this name, if anything has, is a file and not a link to one.
fn must_be_file(dir: &Path, name: &str) -> Result<(), RunError> {
    if fs::symlink_metadata(dir.join(name)).is_ok_and(|metadata| !metadata.is_file()) {
        return Err(RunError::NotARunDirectory {
            dir: dir.to_owned(),
            found: format!("a {name} that is not a file"),
        });
    }
    Ok(())
}

/// Whether a process runs in a run directory just now. Nothing in it is changed. False where a file system has
/// no locks.
///
/// # Example
/// ```
/// assert!(!coinmc::run::is_running(std::path::Path::new("no/such/directory")));
/// ```
pub fn is_running(dir: &Path) -> bool {
    let file = replace::open_file(&dir.join(LOCK));
    // released at once
    file.is_ok_and(|file| matches!(file.try_lock_shared(), Err(TryLockError::WouldBlock)))
}

fn lock(dir: &Path) -> Result<File, RunError> {
    must_be_file(dir, LOCK)?;
    let path = dir.join(LOCK);
    let file = OpenOptions::new()
        .write(true)
        .create(true)
        .truncate(false)
        .open(&path);
    let file = file.map_err(|error| RunError::io("create", &path, error))?;
    // A child process that has been forked and not yet started its program holds copies of all open
    // files. A lock released in the meantime stays held by such a copy for a moment.
    let mut attempts = LOCK_ATTEMPTS;
    let mut locked = file.try_lock();
    while attempts > 0 && matches!(locked, Err(TryLockError::WouldBlock)) {
        attempts -= 1;
        std::thread::sleep(LOCK_PAUSE);
        locked = file.try_lock();
    }
    match locked {
        Ok(()) => Ok(file),
        Err(TryLockError::WouldBlock) => Err(RunError::Locked {
            dir: dir.to_owned(),
        }),
        // Some network file systems have no locks. Two runs in one directory then only repeat each
        // other's work: files are replaced atomically, by the same content.
        Err(TryLockError::Error(error)) if error.kind() == io::ErrorKind::Unsupported => Ok(file),
        Err(TryLockError::Error(error)) => Err(RunError::io("lock", &path, error)),
    }
}

/// `extends`: another config may be there, of the run that this one extends.
fn write_config(
    dir: &Path,
    plan: &Plan,
    extends: bool,
    sink: &dyn ProgressSink,
) -> Result<(), RunError> {
    let path = dir.join(CONFIG);
    let ours = plan.resolved_toml.as_bytes();
    if replace::is_file(&path) {
        let existing = replace::read_bounded(&path, ours.len());
        if existing
            .map_err(|error| RunError::io("read", &path, error))?
            .as_deref()
            == Some(ours)
        {
            return Ok(());
        }
        if !extends {
            let path = path.display();
            sink.warning(&format!(
                "{path} did not match the config of this run and was replaced"
            ));
        }
    }
    replace::replace(&path, ours)
}

//! Merges the parts of a run.

use super::chunk_result::ChunkResult;
use super::cut::Cut;
use super::directory::RunDirectory;
use super::finished::Finished;
use super::in_directory::conclude;
use super::manifest::Manifest;
use super::missing::{Missing, what_is_missing};
use super::packed::Packed;
use super::provenance::Records;
use super::schedule::Schedule;
use super::stored::{read_manifest, stored_plan};
use super::tallies::{Entry, Tallies};
use super::{Chunk, Part, ProgressSink, Report, RunError};
use crate::plan::{Obstacle, Plan};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Merges the parts of a run into a new run directory, byte-identical to that of the whole run. The
/// parts are only read; they may overlap where they agree.
///
/// Everything is checked before anything is written.
///
/// # Errors
/// [`RunError::Missing`] with the chunks that no part holds, [`RunError::Conflict`] if two parts
/// disagree, [`RunError::OtherPlan`] or [`RunError::OtherVersion`] if they are not of one run,
/// [`RunError::Several`] if several directories cannot be used, and
/// what [`run`](super::run) says about a directory it cannot use.
pub fn merge(inputs: &[PathBuf], out: &Path, sink: &dyn ProgressSink) -> Result<Report, RunError> {
    merge_all(inputs, out, false, sink).map(|(report, _)| report)
}

/// Merges what parts there are: where some are missing, they are returned too, and the new run directory is that
/// of a run that was stopped. Later merges into it, and a run in it, go on from there.
///
/// # Errors
/// Those of [`merge`] but [`RunError::Missing`].
pub fn merge_what_is_there(
    inputs: &[PathBuf],
    out: &Path,
    sink: &dyn ProgressSink,
) -> Result<(Report, Option<Missing>), RunError> {
    merge_all(inputs, out, true, sink)
}

/// Merges parts; nothing if some are missing, unless `partly`.
fn merge_all(
    inputs: &[PathBuf],
    out: &Path,
    partly: bool,
    sink: &dyn ProgressSink,
) -> Result<(Report, Option<Missing>), RunError> {
    for input in inputs {
        must_differ(input, out)?;
    }
    let Gathered {
        plan,
        manifest,
        parts,
        mut found,
    } = Gathered::from(inputs, Some(out), sink)?;
    let mut schedule = Schedule::new(&plan, Part::WHOLE, finished(&found));
    let missing = what_is_missing(&plan, &mut schedule, &parts);
    if let Some(missing) = missing.clone().filter(|_| !partly) {
        return Err(RunError::Missing(missing));
    }
    found.retain(|found| found.input < inputs.len());
    let directory = RunDirectory::open_with(out, &plan, manifest, sink);
    let directory = directory.map_err(|error| with_changes(error, &plan, out))?;
    store(&plan, found, &directory, inputs, out, sink)?;
    let report = conclude(&plan, Part::WHOLE, schedule, &directory, sink)?;
    Ok((report, missing))
}

/// Whether the directory holds the run already, in whole or in part.
fn holds_run_of(dir: &Path, manifest: &Manifest) -> bool {
    read_manifest(dir).is_ok_and(|theirs| theirs.must_be_same_run(manifest, dir).is_ok())
}

/// What run directories of one run lack together; `None` if nothing. They are only read, and may still be
/// worked on. Of a run that stops at targets only what is known to be needed is missing.
///
/// # Errors
/// Those of [`merge`] but [`RunError::Missing`].
pub fn missing(inputs: &[PathBuf], sink: &dyn ProgressSink) -> Result<Option<Missing>, RunError> {
    let gathered = Gathered::from(inputs, None, sink)?;
    let finished = finished(&gathered.found);
    let mut schedule = Schedule::new(&gathered.plan, Part::WHOLE, finished);
    Ok(what_is_missing(
        &gathered.plan,
        &mut schedule,
        &gathered.parts,
    ))
}

/// What the parts of a run hold.
struct Gathered {
    plan: Arc<Plan>,
    /// Of the merged run.
    manifest: Manifest,
    parts: Vec<Part>,
    found: Vec<Found>,
}

impl Gathered {
    /// What the parts hold, and `out`, if it holds some of the run already.
    fn from(
        inputs: &[PathBuf],
        out: Option<&Path>,
        sink: &dyn ProgressSink,
    ) -> Result<Self, RunError> {
        let (mut run, mut parts, mut errors) = (None, Vec::new(), Vec::new());
        for input in inputs {
            match add_part(&mut run, input) {
                Ok(part) => parts.push(part),
                Err(error) => errors.push(error),
            }
        }
        if !errors.is_empty() {
            return Err(RunError::all(errors));
        }
        let (plan, manifest) = run.ok_or(RunError::NothingToMerge)?;
        let plan = Arc::new(plan);
        let there = out.filter(|out| holds_run_of(out, &manifest));
        let dirs: Vec<_> = inputs.iter().map(PathBuf::as_path).chain(there).collect();
        let found = collect(&plan, &manifest.plan_hash, &dirs, sink)?;
        Ok(Self {
            plan,
            manifest,
            parts,
            found,
        })
    }
}

/// Adds the directory of a part to the run that the directories before it are of, and says which part it is.
fn add_part(run: &mut Option<(Plan, Manifest)>, dir: &Path) -> Result<Part, RunError> {
    let (plan, manifest) = match run {
        Some(run) => run,
        None => run.insert(first_part(dir)?),
    };
    let theirs = read_manifest(dir)?;
    let same = theirs.must_be_same_run(manifest, dir);
    same.map_err(|error| with_changes(error, plan, dir))?;
    let part = theirs.part(dir)?;
    manifest.targets.extend(theirs.targets);
    manifest.builds.extend(theirs.builds);
    Ok(part)
}

/// The run of a part, and the manifest of that run when no part is merged yet.
fn first_part(dir: &Path) -> Result<(Plan, Manifest), RunError> {
    let plan = stored_plan(dir)?;
    let manifest = Manifest {
        targets: BTreeSet::new(),
        ..Manifest::new(&plan, Part::WHOLE)
    };
    Ok((plan, manifest))
}

/// The error with the keys that differ in place of hashes, where the plan of the directory can be read.
fn with_changes(error: RunError, plan: &Plan, dir: &Path) -> RunError {
    match (error, stored_plan(dir)) {
        (
            RunError::OtherPlan {
                dir, theirs, ours, ..
            },
            Ok(other),
        ) => {
            let changed = Obstacle::Changed(other.changes(plan));
            RunError::OtherPlan {
                dir,
                theirs,
                ours,
                why: Some(changed.to_string()),
            }
        }
        (error, _) => error,
    }
}

fn finished(found: &[Found]) -> Finished {
    let results = found.iter();
    Finished::new(results.map(|found| (found.chunk.clone(), found.result.clone())))
}

/// The result of a chunk and the run directory it came from, the last one for what is there already.
struct Found {
    chunk: Chunk,
    result: Packed,
    input: usize,
}

impl Found {
    fn key(&self) -> (usize, u64) {
        (self.chunk.point, self.chunk.tosses.start)
    }
}

fn must_differ(input: &Path, out: &Path) -> Result<(), RunError> {
    match (fs::canonicalize(input), fs::canonicalize(out)) {
        (Ok(a), Ok(b)) if a == b => Err(RunError::MergeIntoPart {
            dir: out.to_owned(),
        }),
        _ => Ok(()),
    }
}

/// All chunks of run directories, each once, in the order of points and tosses.
fn collect(
    plan: &Plan,
    plan_hash: &str,
    dirs: &[&Path],
    sink: &dyn ProgressSink,
) -> Result<Vec<Found>, RunError> {
    let cut = Cut::new(plan);
    let mut collected = Vec::new();
    for (input, dir) in dirs.iter().enumerate() {
        let tallies = Tallies::of(dir, plan_hash.to_owned());
        tallies.scan(plan, &cut, |entry| {
            match entry {
                Entry::Finished(chunk, result) => collected.push(Found {
                    chunk,
                    result: Packed::from(&*result),
                    input,
                }),
                Entry::Damaged(damage, place) => sink.warning(&format!(
                    "{}, bytes {} to {}: a tally is rejected: {damage}",
                    tallies.path().display(),
                    place.start,
                    place.end
                )),
                Entry::Torn(_) => {}
            }
            Ok(())
        })?;
    }
    collected.sort_by_key(Found::key);
    let disagree = |pair: &&[Found]| {
        let [first, second] = pair else { return false };
        first.key() == second.key() && first.result != second.result
    };
    if let Some([first, second]) = collected.windows(2).find(disagree) {
        return Err(RunError::Conflict {
            chunk: first.chunk.clone(),
            first: dirs[first.input].to_owned(),
            second: dirs[second.input].to_owned(),
        });
    }
    collected.dedup_by_key(|found| found.key());
    Ok(collected)
}

/// Adds to a run directory what it does not hold.
fn store(
    plan: &Plan,
    collected: Vec<Found>,
    directory: &RunDirectory,
    inputs: &[PathBuf],
    out: &Path,
    sink: &dyn ProgressSink,
) -> Result<(), RunError> {
    /// Tallies stored at once.
    const BATCH: usize = 4096;
    let mut existing = directory.finished(plan, sink)?;
    let mut new = Vec::new();
    for found in collected {
        match existing.take(found.chunk.point, found.chunk.tosses.start) {
            Some(there) if there != ChunkResult::from(&found.result) => {
                return Err(RunError::Conflict {
                    chunk: found.chunk,
                    first: inputs[found.input].clone(),
                    second: out.to_owned(),
                });
            }
            Some(_) => {}
            None => new.push(found),
        }
    }
    // before the tallies: a chunk that counts has a maker
    let mut by_input = vec![Vec::new(); inputs.len()];
    for found in &new {
        by_input[found.input].push(&found.chunk);
    }
    for (input, chunks) in inputs.iter().zip(by_input) {
        copy_provenance(input, &chunks, directory)?;
    }
    for batch in new.chunks(BATCH) {
        let results: Vec<_> = batch.iter().map(|found| (&found.result).into()).collect();
        let chunks = batch.iter().map(|found| &found.chunk);
        directory.tallies().store(chunks.zip(&results))?;
    }
    Ok(())
}

/// Adds what a part records of chunks that come from it.
fn copy_provenance(
    input: &Path,
    chunks: &[&Chunk],
    directory: &RunDirectory,
) -> Result<(), RunError> {
    let records = Records::read(input)?;
    let mut entries = vec![Vec::new(); records.makers().len()];
    for chunk in chunks {
        if let Some((entry, maker)) = records.find(chunk.point, chunk.tosses.start) {
            entries[maker].push(*entry);
        }
    }
    for (maker, entries) in records.makers().iter().zip(entries) {
        directory.provenance().add(maker, &entries)?;
    }
    Ok(())
}

//! Merges the parts of a run.

use super::chunk_result::ChunkResult;
use super::cut::Cut;
use super::directory::RunDirectory;
use super::in_directory::conclude;
use super::manifest::Manifest;
use super::schedule::{Finished, Next, Schedule};
use super::stored::{read_manifest, read_plan};
use super::tallies::{Entry, Tallies};
use super::{Chunk, Part, ProgressSink, Report, RunError};
use crate::plan::Plan;
use std::collections::hash_map::Entry as Slot;
use std::collections::{BTreeSet, HashMap};
use std::fs;
use std::path::{Path, PathBuf};

/// Most missing chunks that an error message names.
const NAMED: usize = 20;

/// Merges the parts of a run into a new run directory, byte-identical to that of the whole run. The
/// parts are only read; they may overlap where they agree.
///
/// Everything is checked before anything is written.
///
/// # Errors
/// [`RunError::Missing`] with the chunks that no part holds, [`RunError::Conflict`] if two parts
/// disagree, [`RunError::OtherPlan`] or [`RunError::OtherVersion`] if they are not of one run, and
/// what [`run`](super::run) says about a directory it cannot use.
pub fn merge(inputs: &[PathBuf], out: &Path, sink: &dyn ProgressSink) -> Result<Report, RunError> {
    let first = inputs.first().ok_or(RunError::NothingToMerge)?;
    let plan = read_plan(first)?;
    let mut ours = Manifest {
        targets: BTreeSet::new(),
        ..Manifest::new(&plan, Part::WHOLE)
    };
    for input in inputs {
        must_differ(input, out)?;
        let theirs = read_manifest(input)?;
        theirs.must_be_same_run(&ours, input)?;
        ours.targets.extend(theirs.targets);
        ours.builds.extend(theirs.builds);
    }
    let collected = collect(&plan, &ours.plan_hash, inputs, sink)?;
    must_be_whole(
        &plan,
        collected
            .iter()
            .map(|(key, found)| (*key, found.result))
            .collect(),
    )?;
    write(&plan, ours, collected, inputs, out, sink)
}

/// The result of a chunk and the run directory it came from.
struct Found {
    chunk: Chunk,
    result: ChunkResult,
    input: usize,
}

type Collected = HashMap<(usize, u64), Found>;

fn must_differ(input: &Path, out: &Path) -> Result<(), RunError> {
    match (fs::canonicalize(input), fs::canonicalize(out)) {
        (Ok(a), Ok(b)) if a == b => Err(RunError::MergeIntoPart {
            dir: out.to_owned(),
        }),
        _ => Ok(()),
    }
}

fn collect(
    plan: &Plan,
    plan_hash: &str,
    inputs: &[PathBuf],
    sink: &dyn ProgressSink,
) -> Result<Collected, RunError> {
    let cut = Cut::new(plan);
    let mut collected = Collected::new();
    for (input, dir) in inputs.iter().enumerate() {
        Tallies::of(dir, plan_hash.to_owned()).scan(plan, &cut, |entry| match entry {
            Entry::Finished(chunk, result) => {
                let result = *result;
                match collected.entry((chunk.point, chunk.tosses.start)) {
                    Slot::Occupied(there) if there.get().result != result => {
                        let first = inputs[there.get().input].clone();
                        return Err(RunError::Conflict {
                            chunk,
                            first,
                            second: dir.clone(),
                        });
                    }
                    Slot::Occupied(_) => {}
                    Slot::Vacant(free) => {
                        free.insert(Found {
                            chunk,
                            result,
                            input,
                        });
                    }
                }
                Ok(())
            }
            Entry::Damaged(path, damage) => {
                sink.warning(&format!("{} is rejected: {damage}", path.display()));
                Ok(())
            }
            Entry::Leftover(_) => Ok(()),
        })?;
    }
    Ok(collected)
}

/// Schedules the run with the collected results: a chunk that the schedule still hands out is
/// missing.
fn must_be_whole(plan: &Plan, finished: Finished) -> Result<(), RunError> {
    let mut schedule = Schedule::new(plan, Part::WHOLE, finished);
    let (mut missing, mut total) = (Vec::<Chunk>::new(), 0);
    while let Next::Chunk(chunk) = schedule.next() {
        total += 1;
        let room = missing.len() < NAMED;
        match missing.last_mut() {
            Some(last) if last.point == chunk.point && last.tosses.end == chunk.tosses.start => {
                last.tosses.end = chunk.tosses.end;
            }
            _ if room => missing.push(chunk),
            _ => {}
        }
    }
    if total == 0 {
        Ok(())
    } else {
        Err(RunError::Missing { missing, total })
    }
}

fn write(
    plan: &Plan,
    manifest: Manifest,
    collected: Collected,
    inputs: &[PathBuf],
    out: &Path,
    sink: &dyn ProgressSink,
) -> Result<Report, RunError> {
    /// Tallies stored at once.
    const BATCH: usize = 256;
    let directory = RunDirectory::open_with(out, plan, manifest, sink)?;
    let existing = directory.finished(plan, sink)?;
    let mut new = Vec::new();
    for (key, found) in &collected {
        match existing.get(key) {
            Some(result) if *result != found.result => {
                return Err(RunError::Conflict {
                    chunk: found.chunk.clone(),
                    first: inputs[found.input].clone(),
                    second: out.to_owned(),
                });
            }
            Some(_) => {}
            None => new.push((found.chunk.clone(), found.result)),
        }
    }
    new.chunks(BATCH)
        .try_for_each(|batch| directory.tallies().store(batch))?;
    let finished = collected
        .into_iter()
        .map(|(key, found)| (key, found.result))
        .collect();
    let mut schedule = Schedule::new(plan, Part::WHOLE, finished);
    let whole = schedule.next();
    assert_eq!(whole, Next::Done, "checked before");
    conclude(plan, Part::WHOLE, schedule, &directory, sink)
}

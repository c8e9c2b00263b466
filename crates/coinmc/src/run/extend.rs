//! Lets a run directory go on with a plan that asks for more than the run it holds.
//!
//! The tosses of the earlier run are written under the hash of the new plan to a file of their own. Then the
//! manifest names the new plan: before that instant the directory is the earlier run, with all its files, afterwards
//! it is the new one, of which those tosses are made. [`settle`] gives the file its lasting name, clears away what
//! the earlier run had in files of the new one, and can be repeated.

use super::chunk_result::{ChunkResult, Tossed};
use super::cut::Cut;
use super::earlier::{self, Earlier, Writing};
use super::manifest::Manifest;
use super::stored::read_plan;
use super::tallies::{Entry, Tallies};
use super::{Chunk, Part, ProgressSink, RunError, provenance, replace, unfinished};
use crate::plan::{Change, Extension, Plan};
use std::path::Path;

/// Results of the earlier run, while the one that extends it is not finished.
pub(super) const KEPT: [(&str, &str); 2] = [
    ("results.csv", "results.before.csv"),
    ("results.parquet", "results.before.parquet"),
];

/// The plan of the run in a directory, and how another goes on where it ended.
pub(super) struct Step {
    old: Plan,
    extension: Extension,
}

impl Step {
    /// How `plan` goes on where the run of the directory ended; `None` if its config cannot be read. The caller
    /// has found that the two differ.
    pub(super) fn find(
        dir: &Path,
        plan: &Plan,
        theirs: &Manifest,
        ours: &Manifest,
    ) -> Result<Option<Self>, RunError> {
        let Ok(old) = read_plan(dir) else {
            return Ok(None);
        };
        if old.hash() != theirs.plan_hash {
            return Ok(None);
        }
        let other = |why: String| RunError::OtherPlan {
            dir: dir.to_owned(),
            theirs: theirs.plan_hash.clone(),
            ours: ours.plan_hash.clone(),
            why: Some(why),
        };
        let extension =
            Extension::of(&old, plan).map_err(|obstacle| other(obstacle.to_string()))?;
        let whole = Part::WHOLE.to_string();
        if theirs.part != whole || ours.part != whole {
            let changes = named(&extension.changes);
            return Err(other(format!(
                "{changes}, and a part of a run cannot go on with another plan"
            )));
        }
        Ok(Some(Self { old, extension }))
    }

    /// Makes the directory, of which the lock is held, one of the new plan.
    pub(super) fn take(
        &self,
        dir: &Path,
        theirs: &Manifest,
        ours: &Manifest,
        sink: &dyn ProgressSink,
    ) -> Result<(), RunError> {
        let tosses = self.write(dir, theirs, ours, sink)?;
        if self.extension.moves() {
            // it names points by their place
            replace::remove(&dir.join(provenance::FILE))?;
        }
        replace::sync_directory(dir)?;
        let mut manifest = ours.clone();
        manifest.targets.extend(theirs.targets.iter().cloned());
        manifest.builds.extend(theirs.builds.iter().cloned());
        manifest.write(dir)?;
        replace::sync_directory(dir)?;
        sink.note(&format!(
            "{} held {tosses} tosses of this run with other values ({}) and goes on from them",
            dir.display(),
            named(&self.extension.changes),
        ));
        Ok(())
    }

    /// Writes the tosses of the earlier run; returns how many there are.
    fn write(
        &self,
        dir: &Path,
        theirs: &Manifest,
        ours: &Manifest,
        sink: &dyn ProgressSink,
    ) -> Result<u64, RunError> {
        let (old, mut tosses) = (&self.old, 0_u64);
        let mut writing = Writing::begin(dir, &ours.plan_hash)?;
        let mut add = |chunk: &Chunk, tossed: &Tossed| {
            let Some(point) = self.extension.place(chunk.point) else {
                return Ok(());
            };
            tosses = tosses.saturating_add(tossed.tally.tosses());
            let chunk = Chunk {
                point,
                ..chunk.clone()
            };
            writing.add(&chunk, tossed, &ours.plan_hash)
        };
        let tallies = Tallies::of(dir, theirs.plan_hash.clone());
        tallies.scan(old, &Cut::new(old), |entry| match entry {
            Entry::Finished(chunk, result) => match *result {
                ChunkResult::Tossed(tossed) => add(&chunk, &tossed),
                // as quickly computed again
                ChunkResult::Integrated(_) => Ok(()),
            },
            Entry::Damaged(damage, _) => {
                let path = tallies.path().display();
                sink.warning(&format!(
                    "{path}: a tally is rejected: {damage}. Its tosses are repeated"
                ));
                Ok(())
            }
            Entry::Torn(_) => Ok(()),
        })?;
        for (chunk, tossed) in unfinished::read(dir, &tallies, old)?.values() {
            add(chunk, tossed)?;
        }
        for (chunk, tossed) in Earlier::read(dir, old, &theirs.plan_hash)?.all() {
            add(&chunk, &tossed)?;
        }
        writing.finish()?;
        Ok(tosses)
    }
}

/// Clears away what an earlier run has left in files of the run that extends it, and keeps its results under
/// other names. Returns whether the run extends another.
pub(super) fn settle(dir: &Path, plan_hash: &str) -> Result<bool, RunError> {
    let (file, next) = (dir.join(Earlier::FILE), dir.join(Earlier::NEXT));
    let is_ours = |path: &Path| {
        let plan = earlier::plan_of(path)?;
        Ok::<_, RunError>(plan.as_deref() == Some(plan_hash))
    };
    if is_ours(&next)? {
        replace::rename(&next, &file)?;
    } else {
        // of an extension that was never taken
        replace::remove(&next)?;
    }
    if !is_ours(&file)? {
        replace::remove(&file)?;
        return Ok(false);
    }
    let tallies = dir.join(Tallies::FILE);
    if earlier::plan_of(&tallies)?.is_some_and(|found| found != plan_hash) {
        replace::remove(&tallies)?;
    }
    // the results of the run are written when it no longer has this file
    for (name, kept) in KEPT {
        if replace::is_file(&dir.join(name)) {
            replace::rename(&dir.join(name), &dir.join(kept))?;
        }
    }
    Ok(true)
}

/// Forgets the earlier run: its tosses are tallies of the run that extends it.
pub(super) fn forget(dir: &Path) -> Result<(), RunError> {
    replace::remove(&dir.join(Earlier::FILE))
}

fn named(changes: &[Change]) -> String {
    let named: Vec<String> = changes.iter().map(Change::to_string).collect();
    named.join("; ")
}

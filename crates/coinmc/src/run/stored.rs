//! Reads the plan and the counts of a run directory.

use super::cut::Cut;
use super::directory::CONFIG;
use super::earlier::Earlier;
use super::finished::Finished;
use super::manifest::{self, Manifest};
use super::packed::Packed;
use super::report::{Report, Status, report, status};
use super::schedule::{Next, Schedule};
use super::tallies::{Entry, Tallies};
use super::{Part, ProgressSink, RunError, unfinished};
use crate::config;
use crate::plan::Plan;
use std::path::Path;
use std::sync::Arc;

/// The plan of the run that a directory holds: to replay its tosses, for example.
///
/// # Errors
/// [`RunError::NoRun`], [`RunError::BadConfig`]; [`RunError::ChangedConfig`] if the config
/// is not the one that was run, [`RunError::OtherVersion`] if another version ran it, which may
/// toss differently.
pub fn stored_plan(dir: &Path) -> Result<Plan, RunError> {
    let plan = read_plan(dir)?;
    let (theirs, ours) = (read_manifest(dir)?, Manifest::new(&plan, Part::WHOLE));
    match theirs.must_be_same_run(&ours, dir) {
        // another version may understand the same config otherwise
        Err(RunError::OtherPlan { dir, .. }) if theirs.program_version != ours.program_version => {
            Err(RunError::OtherVersion {
                dir,
                theirs: theirs.program_version,
                ours: ours.program_version,
            })
        }
        Err(RunError::OtherPlan { .. }) => Err(RunError::ChangedConfig {
            path: dir.join(CONFIG),
        }),
        same => same.map(|()| plan),
    }
}

/// The plan of a run directory and all that is counted so far, whether the run is finished, stopped
/// or still in progress. Nothing in the directory is changed; the sink is warned of rejected
/// tallies.
///
/// # Errors
/// Those of [`stored_plan`], and [`RunError::Io`]. The counts of a directory that holds a part of a run are
/// told as those of the whole, which lacks the other parts; its status is that of the part,
/// [`Part`](Status::Part) once that is complete.
pub fn stored_report(dir: &Path, sink: &dyn ProgressSink) -> Result<(Plan, Report), RunError> {
    let plan = Arc::new(stored_plan(dir)?);
    let mut finished = Vec::new();
    let (tallies, cut) = (Tallies::of(dir, plan.hash()), Cut::new(&plan));
    tallies.scan(&plan, &cut, |entry| {
        match entry {
            Entry::Finished(chunk, result) => {
                finished.push((chunk, Packed::from(&*result)));
            }
            Entry::Damaged(damage, _) => {
                let path = tallies.path().display();
                sink.warning(&format!("{path}: a tally is rejected: {damage}"));
            }
            Entry::Torn(_) => {}
        }
        Ok(())
    })?;
    let begun = unfinished::read(dir, &tallies, &plan)?;
    let earlier = Earlier::read(dir, &plan, &plan.hash())?;
    let finished = Finished::new(finished)
        .with_beginnings(begun)
        .with_earlier(earlier);
    let mut schedule = Schedule::new(&plan, Part::WHOLE, finished);
    let part = read_manifest(dir)?.part(dir)?;
    let mut lacks_its_own = false;
    // missing chunks stay handed out
    while let Next::Chunk(job) = schedule.next() {
        lacks_its_own |= part.owns(cut.turn(&job.chunk));
    }
    let status = match (part, lacks_its_own) {
        (Part::WHOLE, _) => status(Part::WHOLE, &schedule),
        (_, false) => Status::Part,
        (_, true) => Status::Interrupted,
    };
    let report = report(&plan, status, schedule);
    Ok((Plan::clone(&plan), report))
}

pub(super) fn read_manifest(dir: &Path) -> Result<Manifest, RunError> {
    Manifest::read(dir)?.ok_or_else(|| RunError::NoRun {
        dir: dir.to_owned(),
        why: if dir.is_dir() {
            format!("it holds no {}", manifest::FILE)
        } else if dir.exists() {
            "it is a file".to_owned()
        } else {
            "there is no such directory".to_owned()
        },
    })
}

pub(super) fn read_plan(dir: &Path) -> Result<Plan, RunError> {
    read_manifest(dir)?;
    let path = dir.join(CONFIG);
    if std::fs::metadata(&path).is_ok_and(|found| !found.is_file() && !found.is_dir()) {
        let why = format!("it holds a {CONFIG} that is not a file");
        let dir = dir.to_owned();
        return Err(RunError::NoRun { dir, why });
    }
    config::load(&path, &[]).map_err(|problems| {
        let reason = problems.to_string();
        RunError::BadConfig { path, reason }
    })
}

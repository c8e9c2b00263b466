//! What a run directory is the run of, read back.

use super::directory::CONFIG;
use super::manifest::{self, Manifest};
use super::{Part, RunError};
use crate::config;
use crate::plan::Plan;
use std::path::Path;

/// The plan whose run a directory holds, for who wants to see its tosses again.
///
/// # Errors
/// [`RunError::NotARunDirectory`], [`RunError::BadConfig`]; [`RunError::OtherPlan`] if the config
/// is not the one that was run, [`RunError::OtherVersion`] if another version ran it, which may
/// toss differently.
pub fn stored_plan(dir: &Path) -> Result<Plan, RunError> {
    let plan = read_plan(dir)?;
    read_manifest(dir)?.must_be_same_run(&Manifest::new(&plan, Part::WHOLE), dir)?;
    Ok(plan)
}

pub(super) fn read_manifest(dir: &Path) -> Result<Manifest, RunError> {
    Manifest::read(dir)?.ok_or_else(|| RunError::NotARunDirectory {
        dir: dir.to_owned(),
        found: format!("no {}", manifest::FILE),
    })
}

pub(super) fn read_plan(dir: &Path) -> Result<Plan, RunError> {
    read_manifest(dir)?;
    let path = dir.join(CONFIG);
    config::load(&path, &[]).map_err(|problems| {
        let reason = problems.to_string();
        RunError::BadConfig { path, reason }
    })
}

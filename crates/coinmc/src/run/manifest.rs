//! `manifest.json`: identifies the run in a directory.

use super::provenance::target;
use super::{Part, RunError, replace};
use crate::plan::Plan;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::io;
use std::path::Path;

/// Version of the run directory's format.
pub(super) const FORMAT: u64 = 2;
pub(super) const FILE: &str = "manifest.json";
/// Largest manifest that is read, bytes.
const MAX_BYTES: usize = 64 << 10;

/// The manifest's fields. See docs/reference/formats.md.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Manifest {
    pub(super) format: u64,
    pub(super) plan_hash: String,
    pub(super) program_version: String,
    /// Builds of that version that worked on the run.
    pub(super) builds: BTreeSet<String>,
    /// Engines that the points name.
    pub(super) engines: BTreeSet<String>,
    /// Kinds of machine that computed tosses.
    pub(super) targets: BTreeSet<String>,
    pub(super) part: String,
}

/// The field that every version has.
#[derive(Deserialize)]
struct AnyFormat {
    format: u64,
}

impl Manifest {
    pub(super) fn new(plan: &Plan, part: Part) -> Self {
        // a config names one engine
        let engines = (0..plan.points.len().min(1)).map(|first| plan.points.at(first));
        let engines = engines.map(|point| point.engine.name().to_owned());
        Self {
            format: FORMAT,
            plan_hash: plan.hash(),
            program_version: env!("CARGO_PKG_VERSION").to_owned(),
            builds: BTreeSet::new(),
            engines: engines.collect(),
            targets: [target()].into(),
            part: part.to_string(),
        }
    }

    /// The manifest of a directory; `None` if it has none.
    pub(super) fn read(dir: &Path) -> Result<Option<Self>, RunError> {
        let path = dir.join(FILE);
        let bad = |reason: String| RunError::BadManifest {
            path: path.clone(),
            reason,
        };
        let bytes = match replace::read_bounded(&path, MAX_BYTES) {
            Ok(Some(bytes)) => bytes,
            Ok(None) => return Err(bad("it is too long".to_owned())),
            Err(error) if is_absent(error.kind()) => return Ok(None),
            Err(error) => return Err(RunError::io("read", &path, error)),
        };
        let AnyFormat { format } =
            serde_json::from_slice(&bytes).map_err(|e| bad(e.to_string()))?;
        if format > FORMAT {
            return Err(RunError::NewerFormat {
                path,
                found: format,
                known: FORMAT,
            });
        }
        if format < FORMAT {
            return Err(RunError::OlderFormat {
                path,
                found: format,
                known: FORMAT,
            });
        }
        serde_json::from_slice(&bytes)
            .map(Some)
            .map_err(|e| bad(e.to_string()))
    }

    pub(super) fn write(&self, dir: &Path) -> Result<(), RunError> {
        let mut text = serde_json::to_string_pretty(self).expect("plain fields are always JSON");
        text.push('\n');
        replace::replace(&dir.join(FILE), text.as_bytes())
    }

    /// Checks that this manifest, read from `dir`, describes the same run and part as `ours`.
    pub(super) fn must_match(&self, ours: &Self, dir: &Path) -> Result<(), RunError> {
        self.must_be_same_run(ours, dir)?;
        if self.part == ours.part {
            return Ok(());
        }
        Err(RunError::OtherPart {
            dir: dir.to_owned(),
            theirs: self.part(dir)?,
            ours: ours.part(dir)?,
        })
    }

    /// Like [`must_match`](Self::must_match), but accepts any part of the run.
    pub(super) fn must_be_same_run(&self, ours: &Self, dir: &Path) -> Result<(), RunError> {
        let dir = dir.to_owned();
        if self.plan_hash != ours.plan_hash {
            let (theirs, ours) = (self.plan_hash.clone(), ours.plan_hash.clone());
            let why = None;
            return Err(RunError::OtherPlan {
                dir,
                theirs,
                ours,
                why,
            });
        }
        if self.program_version != ours.program_version {
            let (theirs, ours) = (self.program_version.clone(), ours.program_version.clone());
            return Err(RunError::OtherVersion { dir, theirs, ours });
        }
        Ok(())
    }

    /// The warning if the run in `dir`, which has this manifest, is resumed by builds that have not
    /// worked on it yet. This is allowed: builds of one version give the same counts, except while
    /// the program is being changed.
    pub(super) fn warning_of_other_builds(&self, ours: &Self, dir: &Path) -> Option<String> {
        if ours.builds.is_subset(&self.builds) {
            return None;
        }
        Some(format!(
            "{} was begun by coinmc {} and is resumed by coinmc {}, another build of the same \
             version. The counts should be the same; its manifest.json names both builds",
            dir.display(),
            listed(&self.builds),
            listed(&ours.builds),
        ))
    }

    pub(super) fn part(&self, dir: &Path) -> Result<Part, RunError> {
        let path = dir.join(FILE);
        self.part.parse().map_err(|e| RunError::BadManifest {
            path,
            reason: format!("{e}"),
        })
    }
}

fn listed(builds: &BTreeSet<String>) -> String {
    let builds: Vec<&str> = builds.iter().map(String::as_str).collect();
    builds.join(", ")
}

/// Whether a file is not there, or what should hold it is itself a file.
fn is_absent(kind: io::ErrorKind) -> bool {
    matches!(kind, io::ErrorKind::NotFound | io::ErrorKind::NotADirectory)
}

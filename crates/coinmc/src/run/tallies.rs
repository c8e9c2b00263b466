//! The directory of tally files: reading what is there, adding what is finished.

use super::cut::Cut;
use super::integral_file;
use super::piece::{Piece, whole};
use super::replace::{self, Replacement, TEMPORARY};
use super::sealed::MAX_BYTES;
use super::tally_file::{self, Damage};
use super::{RunError, Shard};
use crate::plan::Plan;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Added to the name of a file that is not believed.
const REJECTED: &str = ".rejected";

/// Where the tallies of one run directory lie.
#[derive(Debug)]
pub(super) struct Tallies {
    path: PathBuf,
    plan_hash: String,
}

/// One of the directory's files. Files with other names than this program gives are no concern
/// of it.
#[derive(Debug)]
pub(super) enum Entry {
    /// A shard that is finished.
    Finished(Shard, Piece),
    /// A file that is not believed.
    Damaged(PathBuf, Damage),
    /// What a killed run was writing.
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

    /// Looks at every file once, in no particular order.
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
                let read = shard_at(plan, cut, point, start)
                    .ok_or(Damage::NoSuchShard)
                    .map(|shard| self.read(&path, shard, plan));
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

    fn read(&self, path: &Path, shard: Shard, plan: &Plan) -> Result<Entry, RunError> {
        if !replace::is_file(path) {
            return Ok(Entry::Damaged(path.to_owned(), Damage::NotAFile));
        }
        let bytes = replace::read_bounded(path, MAX_BYTES)
            .map_err(|error| RunError::io("read", path, error))?;
        let hash = &self.plan_hash;
        let piece = bytes.ok_or(Damage::TooLong).and_then(|bytes| {
            if let Some(method) = plan.method(shard.point) {
                let integral = integral_file::decode(&bytes, shard.point, method, hash);
                return integral.map(Piece::Integrated);
            }
            tally_file::decode(&bytes, &shard, hash).map(Piece::Tossed)
        });
        Ok(match piece {
            Ok(piece) => Entry::Finished(shard, piece),
            Err(damage) => Entry::Damaged(path.to_owned(), damage),
        })
    }

    /// Adds finished shards, on the disk to stay. Together they cost little more than one: the
    /// first sync takes the others' data along.
    pub(super) fn store(&self, batch: &[(Shard, Piece)]) -> Result<(), RunError> {
        let mut files = Vec::with_capacity(batch.len());
        for (shard, piece) in batch {
            let mut file = Replacement::begin(&self.path.join(tally_file::name(shard)))?;
            let text = match piece {
                Piece::Tossed(tally) => tally_file::encode(shard, tally, &self.plan_hash),
                Piece::Integrated(integral) => {
                    integral_file::encode(shard.point, integral, &self.plan_hash)
                }
            };
            let written = file.writer().write_all(text.as_bytes());
            written.map_err(|error| file.error(error))?;
            files.push(file);
        }
        files.into_iter().try_for_each(Replacement::finish)?;
        replace::sync_directory(&self.path)
    }

    /// Where the file of the shard of `point` that begins at toss `start` stands.
    pub(super) fn place(&self, point: usize, start: u64) -> PathBuf {
        self.path.join(tally_file::name(&Shard {
            point,
            tosses: start..start,
        }))
    }
}

/// The shard of a point that begins at toss `start`, if the plan has one.
fn shard_at(plan: &Plan, cut: &Cut, point: usize, start: u64) -> Option<Shard> {
    if point >= plan.points.len() {
        None
    } else if plan.integrates(point) {
        (start == 0).then(|| whole(point))
    } else if plan.makes_tosses(point) {
        cut.shard_at(point, start)
    } else {
        None
    }
}

/// Moves a file that is not believed out of the way; its new name.
pub(super) fn reject(path: &Path) -> Result<PathBuf, RunError> {
    let mut name = path.as_os_str().to_owned();
    name.push(REJECTED);
    let rejected = PathBuf::from(name);
    fs::rename(path, &rejected).map_err(|error| RunError::io("set aside", path, error))?;
    Ok(rejected)
}

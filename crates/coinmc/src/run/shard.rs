//! The unit of work.

use super::{RunError, engines};
use crate::plan::Plan;
use coinmc_core::Tally;
use std::fmt;
use std::ops::Range;

/// A range of tosses of one point: the only unit of work there is. Threads, machines and a run
/// that goes on after a break all do shards, and shards add up to the same counts however they
/// are cut.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Shard {
    /// Index of the point in the plan.
    pub point: usize,
    /// Numbers of the tosses.
    pub tosses: Range<u64>,
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "point {}, tosses {}..{}",
            self.point, self.tosses.start, self.tosses.end
        )
    }
}

/// Does one shard, on this thread. A point that a closed form answers has no tosses, and its
/// tally stays empty.
///
/// # Errors
/// [`RunError::NoSuchShard`] if the plan has no such point or the range runs backwards;
/// [`RunError::Settings`] if the engine refuses its settings.
pub fn run_shard(plan: &Plan, shard: &Shard) -> Result<Tally, RunError> {
    // nobody asks it to stop
    Ok(run_shard_while(plan, shard, || true)?.unwrap_or_default())
}

/// Does one shard unless `go_on`, asked every now and then, says no: then `None`.
pub(super) fn run_shard_while(
    plan: &Plan,
    shard: &Shard,
    go_on: impl Fn() -> bool,
) -> Result<Option<Tally>, RunError> {
    if shard.point >= plan.points.len() || shard.tosses.start > shard.tosses.end {
        return Err(RunError::NoSuchShard {
            shard: shard.clone(),
            points: plan.points.len(),
        });
    }
    engines::tally(plan, shard.point, shard.tosses.clone(), go_on).map_err(|source| {
        RunError::Settings {
            point: shard.point,
            source,
        }
    })
}

//! The unit of work.

use super::piece::{Piece, integrate_while};
use super::{Begin, RunError, SettingsError, for_each_outcome, stream};
use crate::plan::{EngineChoice, Plan};
use coinmc_core::Tally;
use std::fmt;
use std::ops::Range;

/// Tosses between two questions whether to go on: about 0.1 ms of typical tosses in the plane and
/// 1 ms in space, so that asking costs nothing, and well under 0.1 s of the most tedious ones.
const BATCH: u64 = 64;

/// The same of tosses in time steps: one takes from 1 ms to seconds.
const STEPPED_BATCH: u64 = 1;

/// A range of tosses of one point: the only unit of work there is. Threads, machines and a run
/// that goes on after a break all do chunks, and chunks add up to the same counts however they
/// are cut.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Chunk {
    /// Index of the point in the plan.
    pub point: usize,
    /// Numbers of the tosses.
    pub tosses: Range<u64>,
}

impl fmt::Display for Chunk {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.tosses.is_empty() {
            // of a point that is integrated: one chunk, no tosses
            return write!(f, "point {}", self.point);
        }
        write!(
            f,
            "point {}, tosses {}..{}",
            self.point, self.tosses.start, self.tosses.end
        )
    }
}

/// Does one chunk of tosses, on this thread. A point that a closed form answers has no tosses, and
/// its tally stays empty; one that is integrated is tossed all the same, as
/// `sampling.method = "random"` would.
///
/// # Errors
/// [`RunError::NoSuchChunk`] if the plan has no such point or the range runs backwards;
/// [`RunError::Settings`] if the engine refuses its settings.
pub fn run_chunk(plan: &Plan, chunk: &Chunk) -> Result<Tally, RunError> {
    // nobody asks it to stop
    Ok(run_chunk_while(plan, chunk, || true)?.unwrap_or_default())
}

/// Does one chunk, whatever its point is answered by, unless `go_on`, asked every now and then, says
/// no: then `None`.
pub(super) fn do_chunk_while(
    plan: &Plan,
    chunk: &Chunk,
    go_on: impl Fn() -> bool,
) -> Result<Option<Piece>, RunError> {
    if plan.integrates(chunk.point) {
        let found = integrate_while(plan, chunk.point, plan.goal(), go_on)?;
        return Ok(found.map(Piece::Integrated));
    }
    Ok(run_chunk_while(plan, chunk, go_on)?.map(Piece::Tossed))
}

fn run_chunk_while(
    plan: &Plan,
    chunk: &Chunk,
    go_on: impl Fn() -> bool,
) -> Result<Option<Tally>, RunError> {
    if chunk.point >= plan.points.len() || chunk.tosses.start > chunk.tosses.end {
        return Err(RunError::NoSuchChunk {
            chunk: chunk.clone(),
            points: plan.points.len(),
        });
    }
    tally(plan, chunk, go_on).map_err(|source| RunError::Settings {
        point: chunk.point,
        source,
    })
}

/// The tally of a chunk that there is; `None` if it was told not to go on.
fn tally(
    plan: &Plan,
    chunk: &Chunk,
    go_on: impl Fn() -> bool,
) -> Result<Option<Tally>, SettingsError> {
    let (point, tosses) = (&plan.points[chunk.point], &chunk.tosses);
    let mut tally = Tally::default();
    let batch = match point.engine {
        EngineChoice::Analytic(_) => return Ok(Some(tally)),
        EngineChoice::Rapier(_) => STEPPED_BATCH,
        EngineChoice::Flat(_) | EngineChoice::Volumetric(_) => BATCH,
    };
    if go_on() {
        let stream = stream(plan, chunk.point);
        let begin = Begin::Drawn(&stream);
        for_each_outcome(point, begin, tosses.clone(), |_, outcome| {
            tally.add(outcome);
            tally.tosses() % batch != 0 || go_on()
        })?;
    }
    Ok((tally.tosses() == tosses.end - tosses.start).then_some(tally))
}

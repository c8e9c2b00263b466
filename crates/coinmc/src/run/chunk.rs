//! The unit of work.

use super::piece::{Piece, integrate_while};
use super::{Begin, RunError, for_some_outcomes, stream};
use crate::plan::Plan;
use coinmc_core::{EngineError, Tally};
use std::fmt;
use std::ops::{ControlFlow, Range};

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

/// The tally of a chunk that there is; `None` if it was told not to go on. That is asked whenever an
/// engine hands on outcomes: about every 0.1 ms in the plane, 1 ms in space, after each toss in time
/// steps, and well within 0.1 s of the most tedious tosses.
fn tally(
    plan: &Plan,
    chunk: &Chunk,
    go_on: impl Fn() -> bool,
) -> Result<Option<Tally>, EngineError> {
    let (point, tosses) = (&plan.points[chunk.point], &chunk.tosses);
    let mut tally = Tally::default();
    if !point.engine.makes_tosses() {
        return Ok(Some(tally));
    }
    if go_on() {
        let stream = stream(plan, chunk.point);
        let begin = Begin::Drawn(&stream);
        for_some_outcomes(point, begin, tosses.clone(), &mut |outcomes| {
            for (_, outcome) in outcomes {
                tally.add(outcome);
            }
            if go_on() {
                ControlFlow::Continue(())
            } else {
                ControlFlow::Break(())
            }
        })?;
    }
    Ok((tally.tosses() == tosses.end - tosses.start).then_some(tally))
}

//! The unit of work.

use super::chunk_result::{ChunkResult, Tossed, integrate_while};
use super::made::Made;
use super::provenance::Stopwatch;
use super::{RunError, TossSource, for_some_outcomes, pieces, stream};
use crate::plan::{Plan, Stop};
use coinmc_core::{EngineError, Starts, Tally};
use std::fmt;
use std::num::NonZeroUsize;
use std::ops::{ControlFlow, Range};

/// A range of tosses of one point: the only unit of work. Threads, machines and resumed runs all
/// compute chunks, and the counts of chunks add up to the same total however the run is divided.
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
            // the one chunk of an integrated point has no tosses
            return write!(f, "point {}", self.point);
        }
        write!(
            f,
            "point {}, tosses {}..{}",
            self.point, self.tosses.start, self.tosses.end
        )
    }
}

/// Computes one chunk of tosses on this thread. A point with a closed form has no tosses, so its
/// tally stays empty; a point that a run would integrate is tossed, as with `sampling.method =
/// "random"`.
///
/// # Errors
/// [`RunError::NoSuchChunk`] if the plan has no such point or the range is reversed;
/// [`RunError::Settings`] if the engine rejects its settings.
pub fn run_chunk(plan: &Plan, chunk: &Chunk) -> Result<Tally, RunError> {
    // never stopped, so there is a tally
    Ok(run_chunk_while(plan, chunk, || true)?.unwrap_or_default())
}

/// Computes one chunk, of tosses on so many threads, or of an integration; `None` if `go_on`, which is called
/// from time to time, returned false.
pub(super) fn compute_chunk(
    plan: &Plan,
    chunk: Chunk,
    threads: NonZeroUsize,
    go_on: impl Fn() -> bool + Sync,
) -> Result<Option<Made>, RunError> {
    let done = if plan.integrates(chunk.point) {
        let watch = Stopwatch::start();
        let found = integrate_while(plan, chunk.point, plan.goal(), go_on)?;
        found.map(|integral| (ChunkResult::Integrated(integral), watch.effort()))
    } else {
        let is_timed = matches!(plan.stop, Stop::Targets(targets) if targets.is_timed());
        let done = pieces::tossed(plan, &chunk, threads, &go_on)?;
        done.map(|(tally, effort)| {
            let microseconds = if is_timed { effort.wall_us } else { 0 };
            let tossed = Tossed {
                tally,
                microseconds,
            };
            (ChunkResult::Tossed(tossed), effort)
        })
    };
    Ok(done.map(|(result, effort)| Made {
        chunk,
        result,
        effort,
    }))
}

pub(super) fn run_chunk_while(
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
    tally(plan, chunk, NOTED, go_on).map_err(|source| RunError::Settings {
        point: chunk.point,
        source,
    })
}

/// Tosses made together: the launch of each is noted, a byte, until they have ended.
const NOTED: usize = 1 << 24;

/// The tally of an existing chunk, of which so many tosses are made together; `None` if `go_on` returned
/// false. It is called whenever an engine delivers outcomes: about every 0.1 ms in the plane, every 1 ms
/// in space, after each toss in time steps, and well within 0.1 s for the longest tosses.
fn tally(
    plan: &Plan,
    chunk: &Chunk,
    together: usize,
    go_on: impl Fn() -> bool,
) -> Result<Option<Tally>, EngineError> {
    let (point, tosses) = (&plan.points.at(chunk.point), &chunk.tosses);
    let mut tally = Tally::default();
    if !point.engine.makes_tosses() {
        return Ok(Some(tally));
    }
    let stream = stream(plan, chunk.point);
    for first in tosses.clone().step_by(together) {
        if !go_on() {
            return Ok(None);
        }
        let noted = first..tosses.end.min(first.saturating_add(together as u64));
        let source = TossSource::Drawn(&stream);
        let starts = Starts::default();
        for_some_outcomes(point, source, noted, Some(&starts), &mut |outcomes| {
            for (number, outcome) in outcomes {
                tally.add_started(outcome, starts.up(*number));
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::schedule::tests::plan_of_one;

    /// However many tosses are made together, the counts are the same, those of the face that was up at the launch too.
    #[test]
    fn counts_do_not_depend_on_how_many_tosses_are_made_together() {
        let plan = plan_of_one("tosses = 1000");
        let (point, tosses) = (0, 3..1000);
        let chunk = Chunk { point, tosses };
        let counted = |together| tally(&plan, &chunk, together, || true).unwrap().unwrap();
        let whole = counted(NOTED);
        assert_eq!(whole.tosses(), 997);
        for together in [1, 7, 996, 997, 5000] {
            assert_eq!(counted(together), whole, "{together}");
        }
    }
}

//! What a run reports at its end.

use super::Part;
use super::schedule::Schedule;
use crate::plan::Plan;
use crate::results::{Results, Row};

/// The outcome of a run.
#[derive(Debug, Clone)]
pub struct Report {
    /// All points; those of an unfinished run as far as they are counted.
    pub results: Results,
    /// Whether the run is finished.
    pub status: Status,
    /// Chunks reused from an earlier run.
    pub reused_chunks: u64,
    /// All tosses counted, including those of an earlier run.
    pub tosses: u64,
}

/// Whether a run is finished.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// Every point meets the stop rule.
    Complete,
    /// It was stopped; running it again resumes.
    Interrupted,
    /// Its part is complete; the parts can be merged.
    Part,
    /// Complete, but some points reached the largest number of tosses before their targets.
    ShortOfTarget {
        /// How many.
        points: usize,
    },
}

/// The report of a schedule.
pub(super) fn report(plan: &Plan, part: Part, schedule: &Schedule<'_>) -> Report {
    let points = schedule.points().iter().enumerate();
    let rows = points
        .map(|(i, point)| match &point.integral {
            Some(integral) => Row::integrated(plan, i, integral, point.stopped_by),
            None => match &point.looks {
                Some(looks) if !looks.is_pilot() => {
                    Row::at_look(plan, i, point.tally, point.stopped_by, looks)
                }
                _ => Row::new(plan, i, *point.shown(), point.stopped_by),
            },
        })
        .collect();
    let progress = schedule.progress();
    Report {
        results: Results::new(plan, rows),
        status: status(part, schedule),
        reused_chunks: progress.reused_chunks,
        tosses: progress.tosses_done,
    }
}

fn status(part: Part, schedule: &Schedule<'_>) -> Status {
    if !schedule.is_done() {
        return Status::Interrupted;
    }
    if part != Part::WHOLE {
        return Status::Part;
    }
    match schedule
        .points()
        .iter()
        .filter(|point| !point.stopped_by.is_reached())
        .count()
    {
        0 => Status::Complete,
        points => Status::ShortOfTarget { points },
    }
}

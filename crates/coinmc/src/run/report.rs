//! What a run reports at its end.

use super::Part;
use super::packed::Counted;
use super::schedule::Schedule;
use super::states::States;
use crate::OnDemand;
use crate::plan::Plan;
use crate::results::{Results, Row};
use std::sync::Arc;

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
    /// Tosses that the run will have when it is finished, as far as is known: a run that stops at targets finds
    /// out.
    pub tosses_planned: u64,
}

impl Report {
    /// Points that met the stop rule.
    pub fn points_reached(&self) -> usize {
        let rows = self.results.rows.each();
        rows.filter(|row| row.stopped_by.is_reached()).count()
    }
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
pub(super) fn report(plan: &Arc<Plan>, status: Status, schedule: Schedule) -> Report {
    let progress = schedule.progress();
    let (states, of) = (schedule.into_states(), Arc::clone(plan));
    let rows = OnDemand::made(states.len(), move |point| row(&of, point, &states));
    Report {
        results: Results::new(plan, rows),
        status,
        reused_chunks: progress.reused_chunks,
        tosses: progress.tosses_done,
        tosses_planned: progress.tosses_planned,
    }
}

fn row(plan: &Plan, point: usize, states: &States) -> Row {
    let Counted {
        tally,
        integral,
        look,
        stopped_by,
    } = states.counted(point);
    match (integral, look) {
        (Some(integral), _) => Row::integrated(plan, point, &integral, stopped_by),
        (None, Some((pilot_tosses, confidence))) => Row {
            pilot_tosses,
            ..Row::with_confidence(plan, point, tally, stopped_by, confidence)
        },
        (None, None) => Row::new(plan, point, tally, stopped_by),
    }
}

/// Whether a schedule is finished.
pub(super) fn status(part: Part, schedule: &Schedule) -> Status {
    if !schedule.is_done() {
        return Status::Interrupted;
    }
    if part != Part::WHOLE {
        return Status::Part;
    }
    let short = (0..schedule.points()).filter(|&point| {
        let stopped_by = schedule.counted(point).stopped_by;
        !stopped_by.is_reached()
    });
    match short.count() {
        0 => Status::Complete,
        points => Status::ShortOfTarget { points },
    }
}

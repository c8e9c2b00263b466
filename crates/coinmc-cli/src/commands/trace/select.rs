//! Selection of tosses: given or searched for.

use super::Trace;
use crate::exit::Failure;
use crate::terminal::progress::Progress;
use coinmc::plan::Plan;
use coinmc_trace::{Condition, EndKind, MAX_RATE_HZ, Query, TraceError, launch, search};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Time between updates of the progress.
const PAUSE: Duration = Duration::from_millis(50);
/// Greatest number of tosses per command.
const MAX: usize = 1000;

/// The tosses to trace, by point and number.
#[derive(Debug)]
pub(super) struct Selected {
    pub(super) tosses: Vec<(usize, u64)>,
    /// Number of tosses searched; `None` without a search.
    pub(super) searched: Option<u64>,
    pub(super) status: Status,
}

/// Whether the search was complete.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Status {
    Complete,
    /// Fewer were found than requested. `limit`: there were more tosses to search.
    Short {
        limit: bool,
    },
    Interrupted,
}

/// The requested points.
pub(super) fn points(trace: &Trace, plan: &Plan) -> Vec<usize> {
    if !trace.points.is_empty() {
        trace.points.clone()
    } else if trace.tosses.is_empty() {
        (0..plan.points.len()).collect()
    } else {
        vec![0]
    }
}

/// Rejects tosses that do not exist before the work begins.
pub(super) fn check(trace: &Trace, plan: &Plan) -> Result<(), Failure> {
    if !trace.tosses.is_empty() && trace.tosses.len() * points(trace, plan).len() > MAX {
        return Err(Failure::Input(anyhow::anyhow!(
            "at most {MAX} tosses can be traced at a time"
        )));
    }
    if let Some([first, second]) = contradiction(&trace.conditions) {
        return Err(Failure::Input(anyhow::anyhow!(
            "no toss has both {first} and {second}"
        )));
    }
    if let Some(rate) = trace
        .rate
        .filter(|rate| !(0.0..=MAX_RATE_HZ).contains(rate))
    {
        return Err(TraceError::Rate(rate).into());
    }
    // a search would reach its last point late
    let firsts = points(trace, plan).into_iter().map(|point| (point, 0));
    for (point, toss) in firsts.chain(named(trace, plan)) {
        launch(plan, point, toss)?;
    }
    Ok(())
}

/// The first two conditions that no toss meets together.
fn contradiction(conditions: &[Condition]) -> Option<[String; 2]> {
    let excludes = |first: &Condition, second: &Condition| match (first, second) {
        (Condition::Face(_), Condition::Ended(end))
        | (Condition::Ended(end), Condition::Face(_)) => *end != EndKind::Decided,
        (first, second) => first != second,
    };
    let told = |condition: &Condition| match condition {
        Condition::Face(face) => format!("face={}", face.name()),
        Condition::Ended(end) => format!("ended={}", end.name()),
    };
    conditions.iter().enumerate().find_map(|(i, second)| {
        let first = conditions[..i]
            .iter()
            .find(|first| excludes(first, second))?;
        Some([told(first), told(second)])
    })
}

/// All given tosses of all given points.
fn named(trace: &Trace, plan: &Plan) -> Vec<(usize, u64)> {
    let points = points(trace, plan).into_iter();
    points
        .flat_map(|point| trace.tosses.iter().map(move |&toss| (point, toss)))
        .collect()
}

pub(super) fn select(
    trace: &Trace,
    plan: &Plan,
    cancel: &AtomicBool,
    progress: &Progress,
) -> Result<Selected, Failure> {
    if !trace.tosses.is_empty() {
        return Ok(Selected {
            tosses: named(trace, plan),
            searched: None,
            status: Status::Complete,
        });
    }
    let points = points(trace, plan);
    let query = Query {
        points: &points,
        conditions: &trace.conditions,
        longest: trace.longest.map(Into::into),
        count: usize::from(trace.count),
        limit: trace.limit,
    };
    progress.searched(0, trace.limit);
    let mut shown = Instant::now();
    let findings = search(plan, &query, |searched| {
        // a toss may take a microsecond or a second
        if shown.elapsed() >= PAUSE {
            progress.searched(searched, trace.limit);
            shown = Instant::now();
        }
        !cancel.load(Ordering::Relaxed)
    })?;
    let status = if cancel.load(Ordering::Relaxed) {
        Status::Interrupted
    } else if findings.found.len() < query.count {
        Status::Short {
            limit: findings.is_cut,
        }
    } else {
        Status::Complete
    };
    Ok(Selected {
        tosses: findings.found.iter().map(|f| (f.point, f.toss)).collect(),
        searched: Some(findings.searched),
        status,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conditions_that_exclude_each_other_are_noticed() {
        for (texts, excluded) in [
            (&["face=side"][..], false),
            (&["face=side", "face=side", "ended=decided"], false),
            (&["face=side", "face=heads"], true),
            (&["ended=decided", "ended=failed"], true),
            (&["ended=time_limit", "face=side"], true),
        ] {
            let conditions: Result<Vec<Condition>, _> = texts.iter().map(|t| t.parse()).collect();
            let found = contradiction(&conditions.expect("conditions"));
            assert_eq!(found.is_some(), excluded, "{texts:?}");
        }
    }
}

//! Which tosses a report shows in three dimensions.

use crate::replay;
use coinmc::OnDemand;
use coinmc::plan::Plan;
use coinmc::results::Row;
use coinmc_core::Face;
use coinmc_trace::{Condition, Query, TraceError, default_rate_hz, launch, replay_within, search};
use serde_json::Value;

/// Most tosses that are searched for one that shows a face.
const LIMIT: u64 = 500;
/// Most records of a toss, of which the page keeps a part.
pub(crate) const MOST_RECORDS: usize = 40_000;

/// Which tosses of each run to show.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Samples {
    /// The point; by default that of which P(side) is closest to 1/3.
    pub point: Option<usize>,
    /// The tosses; by default the first that shows each face, if one is found soon.
    pub tosses: Vec<u64>,
}

impl Samples {
    /// The tosses to show of a run.
    ///
    /// # Errors
    /// [`TraceError`] if a point or toss that was asked for does not exist.
    pub(crate) fn of(&self, plan: &Plan, rows: &OnDemand<Row>) -> Result<Vec<Value>, TraceError> {
        let Some(point) = self.point.or_else(|| fairest(plan, rows)) else {
            return Ok(Vec::new());
        };
        let tosses = if self.tosses.is_empty() {
            one_of_each_face(plan, point)?
        } else {
            self.tosses.clone()
        };
        let show = |toss: &u64| show(plan, point, *toss);
        tosses.iter().map(show).collect()
    }
}

/// A toss for the page.
pub(crate) fn show(plan: &Plan, point: usize, toss: u64) -> Result<Value, TraceError> {
    let start = launch(plan, point, toss)?;
    let rate = default_rate_hz(&plan.points[point].scene, &start);
    let trace = replay_within(plan, point, toss, rate, MOST_RECORDS)?;
    Ok(replay::toss(plan, &trace, &plan.axes))
}

/// The point with tosses of which P(side) is closest to that of a fair coin.
fn fairest(plan: &Plan, rows: &OnDemand<Row>) -> Option<usize> {
    let tossed = rows
        .iter()
        .filter(|row| plan.points.at(row.point).engine.makes_tosses());
    let unfairness = |row: &Row| {
        let away = (row.side.p - 1.0 / 3.0).abs();
        if away.is_finite() { away } else { 1.0 }
    };
    let fairest = tossed.min_by(|a, b| unfairness(a).total_cmp(&unfairness(b)));
    fairest.map(|row| row.point)
}

/// The first toss that shows each face.
fn one_of_each_face(plan: &Plan, point: usize) -> Result<Vec<u64>, TraceError> {
    let mut tosses = Vec::new();
    for face in [Face::Side, Face::Heads, Face::Tails] {
        let query = Query {
            points: &[point],
            conditions: &[Condition::Face(face)],
            longest: None,
            count: 1,
            limit: LIMIT,
        };
        let findings = search(plan, &query, |_| true)?;
        tosses.extend(findings.found.iter().map(|found| found.toss));
    }
    Ok(tosses)
}

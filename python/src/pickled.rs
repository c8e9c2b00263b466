//! Results as plain Python values, and back: for pickles.

use crate::errors;
use crate::plan::Plan;
use crate::results::Results;
use coinmc::plan::StoppedBy;
use coinmc::results::{Results as Table, Row};
use coinmc::run::{Report, Status};
use coinmc_core::{Estimate, Tally};
use pyo3::prelude::*;

/// An estimate: p, both ends of its interval, tosses or evaluations.
type Interval = (f64, f64, f64, u64);

/// A row: what the plan does not say of it.
#[derive(FromPyObject, IntoPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct PlainRow {
    counts: Vec<u64>,
    faces: [Interval; 3],
    same: Option<Interval>,
    left: Option<Interval>,
    how: [String; 2],
    evaluations: u64,
    stopped_by: String,
    pilot_tosses: u64,
}

/// Status, its number of points, tosses, version of the program, rows.
pub(crate) type Plain = (String, usize, u64, String, Vec<PlainRow>);

/// The plain values of results.
pub(crate) fn plain(results: &Results) -> Plain {
    let short = match results.status {
        Status::ShortOfTarget { points } => points,
        _ => 0,
    };
    let table = results.table();
    (
        results.status_name().to_owned(),
        short,
        results.tosses,
        table.program_version.clone(),
        table.rows.each().map(|row| plain_row(&row)).collect(),
    )
}

fn interval(estimate: &Estimate) -> Interval {
    (estimate.p, estimate.lo, estimate.hi, estimate.n)
}

fn plain_row(row: &Row) -> PlainRow {
    PlainRow {
        counts: row.tally.to_array().to_vec(),
        faces: [&row.heads, &row.tails, &row.side].map(interval),
        same: row.same.as_ref().map(interval),
        left: row.left.as_ref().map(interval),
        how: [row.interval, row.sampling].map(str::to_owned),
        evaluations: row.evaluations,
        stopped_by: row.stopped_by.name().to_owned(),
        pilot_tosses: row.pilot_tosses,
    }
}

/// The results of a plan from their plain values.
#[pyfunction]
pub(crate) fn unpickled(plan: &Plan, plain: Plain) -> PyResult<Results> {
    let (status, short, tosses, program_version, rows) = plain;
    if rows.len() != plan.0.points.len() {
        return Err(errors::value("these results have other points"));
    }
    let rows = rows.into_iter().enumerate();
    let rows = rows.map(|(index, row)| row.of(plan, index));
    let rows = rows.collect::<Option<Vec<_>>>();
    let rows = rows.ok_or_else(|| errors::value("these results are of another version"))?;
    Results::new(Report {
        results: Table {
            program_version,
            ..Table::new(&plan.0, rows.into())
        },
        status: match status.as_str() {
            "complete" => Status::Complete,
            "part" => Status::Part,
            "short" => Status::ShortOfTarget { points: short },
            _ => Status::Interrupted,
        },
        reused_chunks: 0,
        tosses,
        tosses_planned: tosses,
    })
}

impl PlainRow {
    fn of(self, plan: &Plan, index: usize) -> Option<Row> {
        let tally = Tally::from_array(self.counts.try_into().ok()?);
        let stopped_by = StoppedBy::named(&self.stopped_by)?;
        let estimate = |(p, lo, hi, n): Interval| Estimate {
            p,
            lo,
            hi,
            n,
            confidence: plan.0.confidence,
            method: plan.0.interval,
        };
        let [heads, tails, side] = self.faces.map(estimate);
        let [interval, sampling] = self.how;
        let found = Row::new(&plan.0, index, tally, stopped_by);
        Some(Row {
            heads,
            tails,
            side,
            same: self.same.map(estimate),
            left: self.left.map(estimate),
            interval: Row::interval_named(&interval)?,
            sampling: Row::sampling_named(&sampling)?,
            evaluations: self.evaluations,
            pilot_tosses: self.pilot_tosses,
            published: found.published.filter(|_| self.evaluations == 0),
            ..found
        })
    }
}

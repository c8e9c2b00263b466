//! What others published for the same launch.

use coinmc::published::{TABLE1_SOURCE, fair_ratios};
use coinmc::results::{Results, Row};
use coinmc_core::{Estimate, IntervalMethod};
use serde_json::{Value, json};

/// Published counts beside those of a run, and published fair ratios of its kinds of toss.
pub(crate) fn to_json(results: &Results) -> Value {
    let mut engines: Vec<&str> = results.rows.iter().map(|row| row.engine).collect();
    engines.sort_unstable();
    engines.dedup();
    let fair = engines.into_iter().flat_map(fair_ratios).map(
        |fair| json!({ "ratio": fair.ratio, "half_width": fair.half_width, "source": fair.source }),
    );
    json!({
        "source": TABLE1_SOURCE,
        "counts": results.rows.iter().filter_map(counts).collect::<Vec<_>>(),
        "fair_ratios": fair.collect::<Vec<_>>(),
    })
}

fn counts(row: &Row) -> Option<Value> {
    let published = row.published.as_ref()?;
    let counts = &published.counts;
    let method = IntervalMethod::Wilson;
    let theirs = Estimate::new(counts.side, 0, counts.tosses(), row.side.confidence, method);
    Some(json!({
        "point": row.point,
        "ratio": counts.ratio,
        "ours": [row.side.p, row.side.lo, row.side.hi],
        "theirs": [theirs.p, theirs.lo, theirs.hi],
        "side": counts.side,
        "tosses": counts.tosses(),
        "z": counts.z_score(row.tally.side, row.tally.tosses()),
        "differs": published.differs,
    }))
}

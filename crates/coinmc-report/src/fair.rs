//! Where P(side) crosses 1/3 along each swept parameter.

use coinmc::results::{FairRatio, Results, fair_values};
use coinmc_core::Face;
use serde_json::{Value, json};

/// P(side) of a fair coin.
const FAIR: f64 = 1.0 / 3.0;
/// Most crossings that a page lists along a parameter.
const MOST: usize = 500;

/// For each axis along which P(side) crosses 1/3 somewhere: the crossings.
pub(crate) fn to_json(results: &Results) -> Value {
    let axes = results.axes.iter().filter_map(|axis| {
        let found = fair_values(results, Face::Side, axis, FAIR);
        let listed: Vec<Value> = found.iter().take(MOST).map(crossing).collect();
        (!found.is_empty())
            .then(|| json!({ "along": axis, "found": found.len(), "crossings": listed }))
    });
    axes.collect()
}

fn crossing(fair: &FairRatio) -> Value {
    let at: Vec<Value> = fair
        .at
        .iter()
        .map(|(name, value)| json!([name, value]))
        .collect();
    json!({
        "at": at,
        "engine": fair.engine,
        "law": fair.law,
        "value": fair.ratio,
        "lo": fair.lo,
        "hi": fair.hi,
        "confidence": fair.confidence,
        "rising": fair.rising,
    })
}

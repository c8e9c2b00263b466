//! The closed form beside the points: what P(side) would be if nothing bounced.

use coinmc::engines::no_bounce_rule;
use coinmc::results::{Results, Row};
use serde_json::{Value, json};

/// Places of a curve over the ratio.
const STEPS: u32 = 120;

/// The closed form for the first engine that has one: its value at every row, and a curve over the ratio.
/// `null` where there is none.
pub(crate) fn to_json(results: &Results) -> Value {
    let rule = results
        .rows
        .iter()
        .find_map(|row| no_bounce_rule(row.engine));
    let Some(rule) = rule else {
        return Value::Null;
    };
    let p_side = |row: &Row| row.parameter("ratio").map(|ratio| rule.p_side(ratio));
    let ratios = || results.rows.iter().filter_map(|row| row.parameter("ratio"));
    let (from, to) = ratios().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| {
        (a.min(x), b.max(x))
    });
    let curve: Vec<f64> = if from < to {
        (0..=STEPS)
            .map(|i| from + (to - from) * f64::from(i) / f64::from(STEPS))
            .collect()
    } else {
        Vec::new()
    };
    json!({
        "name": format!("{rule} rule (no bounce)"),
        "fair_ratio": rule.fair_ratio(1.0 / 3.0),
        "rows": results.rows.iter().map(p_side).collect::<Vec<_>>(),
        "curve": { "ratio": curve, "p_side": curve.iter().map(|&x| rule.p_side(x)).collect::<Vec<_>>() },
    })
}

//! An answer as a JSON document.

use super::{Compared, Comparison};
use crate::document::FORMAT_VERSION;
use coinmc_core::{Estimate, Face};
use serde_json::{Map, Value, json};

/// A [`Comparison`] as a JSON document, with the number of a robot's void throws, if its journal was counted.
/// docs/reference/formats.md describes its fields.
pub fn document_of_comparison(comparison: &Comparison<'_>, voids: Option<u64>) -> Value {
    let [heads, tails, side] = comparison.counts;
    json!({
        "format_version": FORMAT_VERSION,
        "kind": "compare",
        "heads": heads,
        "tails": tails,
        "side": side,
        "voids": voids,
        "confidence": comparison.seen[0].confidence,
        "seen": faces(|face| comparison.seen[face as usize]),
        "left_out": comparison.left_out,
        "rows": comparison.models.iter().map(row).collect::<Vec<_>>(),
    })
}

fn faces(estimate: impl Fn(Face) -> Estimate) -> Value {
    let of = |face: Face| {
        let Estimate { p, lo, hi, .. } = estimate(face);
        (
            face.name().to_owned(),
            json!({ "p": p, "lo": lo, "hi": hi }),
        )
    };
    Value::Object(Face::ALL.into_iter().map(of).collect())
}

fn row(compared: &Compared<'_>) -> Value {
    let row = compared.model.row;
    let parameters: Map<String, Value> = row
        .parameters
        .iter()
        .map(|(name, value)| (name.to_string(), json!(value)))
        .collect();
    json!({
        "run": compared.model.run,
        "point": row.point,
        "parameters": parameters,
        "engine": row.engine,
        "law": row.law,
        "tosses": row.tally.tosses(),
        "undecided": row.tally.undecided(),
        "left": row.tally.left,
        "model": faces(|face| compared.estimate(face)),
        "p_value": compared.p_value,
        "p_value_at_best": compared.p_value_at_best,
        "evidence": compared.evidence,
        "share": compared.share,
        "tosses_to_tell": compared.tosses_to_tell,
    })
}

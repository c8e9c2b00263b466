//! A validation as a JSON document: what the command line prints and Python reads.

use crate::claims::Checked;
use crate::sets::{Line, Predicted};
use crate::{Evidence, Validation};
use serde_json::{Value, json};

/// Version of the document. It stays when fields are added, and changes when a field changes its meaning or is
/// removed.
const FORMAT_VERSION: u32 = 1;

/// The confidence of all intervals.
const CONFIDENCE: f64 = 0.95;

/// A [`Validation`] as a JSON document. docs/reference/formats.md describes its fields.
pub fn document(validation: &Validation) -> Value {
    json!({
        "format_version": FORMAT_VERSION,
        "kind": "validate",
        "mode": validation.size.name(),
        "seed": validation.seed,
        "level": Validation::LEVEL,
        "confidence": CONFIDENCE,
        "prior": {
            "text": Validation::prior(),
            "draws": validation.draws,
            "tosses_of_draw": validation.tosses_of_draw,
        },
        "claims": validation.claims.iter().map(claim).collect::<Vec<_>>(),
        "sets": validation.sets.iter().map(set).collect::<Vec<_>>(),
        "predicted": validation.predicted().count(),
        "not_rejected": validation.not_rejected(),
    })
}

fn claim(checked: &Checked) -> Value {
    let Checked { claim, finding } = checked;
    json!({
        "name": claim.name,
        "family": claim.family.name(),
        "statement": claim.statement,
        "verdict": finding.verdict.name(),
        "condition": finding.verdict.condition(),
        "tosses": finding.tosses(),
        "evidence": finding.evidence.iter().map(evidence).collect::<Vec<_>>(),
    })
}

fn evidence(evidence: &Evidence) -> Value {
    let [lo, hi] = evidence
        .interval
        .map_or([None, None], |[lo, hi]| [Some(lo), Some(hi)]);
    json!({
        "what": evidence.what,
        "value": evidence.value,
        "lo": lo,
        "hi": hi,
        "tosses": evidence.tosses,
    })
}

fn set(predicted: &Predicted) -> Value {
    let set = predicted.set;
    json!({
        "name": set.name,
        "kind": set.kind.name(),
        "doc": set.doc,
        "source": set.source,
        "stated": set.stated,
        "verdict": verdict(predicted),
        "condition": predicted.why_not(),
        "p_value": predicted.p_value,
        "p_error": predicted.p_value.map(|_| predicted.p_error),
        "tosses": predicted.own_tosses(),
        "lines": predicted.lines.iter().map(line).collect::<Vec<_>>(),
    })
}

fn verdict(predicted: &Predicted) -> &'static str {
    match predicted.is_rejected(Validation::LEVEL) {
        Some(true) => "rejected",
        Some(false) => "not rejected",
        None => "not validated",
    }
}

fn line(line: &Line) -> Value {
    json!({
        "name": line.name,
        "quantity": line.quantity,
        "seen": line.seen,
        "seen_tosses": line.tosses,
        "predicted": line.predicted,
        "lo": line.range[0],
        "hi": line.range[1],
        "p_value": line.p_value,
        "p_error": line.p_error,
        "tosses": line.own_tosses,
    })
}

/// The rows of a [`document()`] without nesting, for a table: one for each claim, and one for each line of
/// a data set (and for each set that was not predicted).
pub fn flat_rows(document: &Value) -> Value {
    let list = |key: &str| document[key].as_array().cloned().unwrap_or_default();
    let mut rows = vec![];
    for claim in list("claims") {
        rows.push(json!({
            "family": claim["family"],
            "name": claim["name"],
            "what": claim["statement"],
            "verdict": claim["verdict"],
            "condition": claim["condition"],
            "first": true, "quantity": null, "line": null, "seen": null, "seen_tosses": null,
            "predicted": null, "lo": null, "hi": null, "p_line": null, "p_value": null, "p_error": null,
            "tosses": claim["tosses"],
        }));
    }
    for set in list("sets") {
        let lines = set["lines"].as_array().cloned().unwrap_or_default();
        let empty = [Value::Null];
        let lines = if lines.is_empty() { &empty[..] } else { &lines[..] };
        for (place, line) in lines.iter().enumerate() {
            rows.push(json!({
                "family": "data",
                "name": set["name"],
                "what": set["doc"],
                "verdict": set["verdict"],
                "condition": set["condition"],
                // so that a table can have one row for each set
                "first": place == 0,
                "quantity": line["quantity"],
                "line": line["name"],
                "seen": line["seen"],
                "seen_tosses": line["seen_tosses"],
                "predicted": line["predicted"],
                "lo": line["lo"],
                "hi": line["hi"],
                "p_line": line["p_value"],
                "p_value": set["p_value"],
                "p_error": set["p_error"],
                "tosses": line["tosses"],
            }));
        }
    }
    json!({ "rows": rows })
}

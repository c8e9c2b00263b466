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
        "p_error": error(predicted.p_error),
        "tosses": predicted.own_tosses(),
        "lines": predicted.lines.iter().map(line).collect::<Vec<_>>(),
    })
}

/// Of a p-value: none without draws.
fn error(error: f64) -> Option<f64> {
    (error > 0.0).then_some(error)
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
        "p_error": error(line.p_error),
        "tosses": line.own_tosses,
    })
}

/// The rows of a [`document()`] without nesting, for a table: one for each claim and one for each number of its
/// evidence, one for each line of a data set, and one for each set that was not predicted.
pub fn flat_rows(document: &Value) -> Value {
    let list = |key: &str| document[key].as_array().cloned().unwrap_or_default();
    let claims = list("claims").into_iter().flat_map(|claim| {
        let verdict = row(
            &claim,
            &claim["family"],
            &claim["statement"],
            &Value::Null,
            true,
        );
        let evidence = claim["evidence"].as_array().cloned().unwrap_or_default();
        let numbers = evidence.into_iter().map(|number| {
            let number = json!({
                "name": number["what"],
                "predicted": number["value"],
                "lo": number["lo"],
                "hi": number["hi"],
                "tosses": number["tosses"],
            });
            row(
                &claim,
                &claim["family"],
                &claim["statement"],
                &number,
                false,
            )
        });
        [verdict].into_iter().chain(numbers).collect::<Vec<_>>()
    });
    let sets = list("sets").into_iter().flat_map(|set| {
        let mut lines = set["lines"].as_array().cloned().unwrap_or_default();
        if lines.is_empty() {
            lines.push(Value::Null);
        }
        let of = |(place, line)| row(&set, &json!("data"), &set["doc"], line, place == 0);
        lines.iter().enumerate().map(of).collect::<Vec<_>>()
    });
    json!({ "rows": claims.chain(sets).collect::<Vec<_>>() })
}

/// A row of a claim or data set, about one of its numbers unless that is null.
fn row(of: &Value, family: &Value, what: &Value, number: &Value, first: bool) -> Value {
    let tosses = if number.is_null() { of } else { number };
    json!({
        "family": family,
        "name": of["name"],
        "what": what,
        "verdict": of["verdict"],
        "condition": of["condition"],
        // so that a table can have one row for each claim and set
        "first": first,
        "line": number["name"],
        "quantity": number["quantity"],
        "seen": number["seen"],
        "seen_tosses": number["seen_tosses"],
        "predicted": number["predicted"],
        "lo": number["lo"],
        "hi": number["hi"],
        "p_line": number["p_value"],
        "p_value": of["p_value"],
        "p_error": of["p_error"],
        "tosses": tosses["tosses"],
    })
}

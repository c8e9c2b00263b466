//! An answer as a JSON document.

use super::{Rareness, Stratum};
use crate::document::FORMAT_VERSION;
use serde_json::{Value, json};

/// The answer to a [`HowRare`](super::HowRare) as a JSON document. docs/reference/formats.md describes
/// its fields.
pub fn document_of_rare(answer: &Rareness) -> Value {
    let question = &answer.question;
    json!({
        "format_version": FORMAT_VERSION,
        "kind": "rare",
        "face": question.face.name(),
        "relative_error": question.relative_error,
        "confidence": answer.confidence,
        "engine": answer.engine,
        "law": answer.law,
        "p": answer.p.value,
        "lo": answer.p.lo,
        "hi": answer.p.hi,
        "hi_without_undecided": answer.without_undecided.hi,
        "reached": answer.reached,
        "limited_by_undecided": answer.is_limited_by_undecided(),
        "launches": answer.launches,
        "tosses": answer.tosses,
        "shown": answer.shown,
        "undecided": answer.undecided,
        "pilot_tosses": answer.pilot_tosses,
        // NaN is null
        "gain": answer.gain().tosses,
        "gain_of_work": answer.gain().work,
        "rows": answer.strata.iter().map(stratum).collect::<Vec<_>>(),
    })
}

fn stratum(stratum: &Stratum) -> Value {
    json!({
        "cos_from": stratum.from,
        "cos_to": stratum.to,
        "launches": stratum.launches,
        "chance": stratum.chance,
        "tosses": stratum.tosses,
        "shown": stratum.shown,
    })
}

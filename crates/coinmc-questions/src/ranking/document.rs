//! A ranking as a JSON document.

use super::{Ranked, Ranking};
use crate::Interval;
use crate::document::FORMAT_VERSION;
use serde_json::{Value, json};

/// The answer to a [`Rank`](super::Rank) as a JSON document. docs/reference/formats.md describes its
/// fields.
pub fn document_of_ranking(ranking: &Ranking) -> Value {
    let question = &ranking.question;
    let p = &ranking.p;
    json!({
        "format_version": FORMAT_VERSION,
        "kind": "ranking",
        "face": question.face.name(),
        "samples": question.samples,
        "tosses_of_an_end": question.tosses,
        "confidence": ranking.confidence,
        "engine": ranking.engine,
        "law": ranking.law,
        "tosses": ranking.tosses,
        "undecided": ranking.undecided,
        "p": { "value": p.p, "lo": p.lo, "hi": p.hi },
        "mean": interval(&ranking.mean),
        "standard_deviation": interval(&ranking.deviation),
        "rows": ranking.numbers.iter().map(row).collect::<Vec<_>>(),
    })
}

fn row(ranked: &Ranked) -> Value {
    let [at_from, at_to] = &ranked.ends;
    json!({
        "parameter": ranked.unknown.key,
        "value": ranked.value,
        "from": ranked.unknown.from,
        "to": ranked.unknown.to,
        "p_from": interval(at_from),
        "p_to": interval(at_to),
        "undecided_from": ranked.undecided[0],
        "undecided_to": ranked.undecided[1],
        "first": ranked.first.as_ref().map(interval),
        "total": ranked.total.as_ref().map(interval),
    })
}

fn interval(interval: &Interval) -> Value {
    json!({ "value": interval.value, "lo": interval.lo, "hi": interval.hi })
}

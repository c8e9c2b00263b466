//! The answer as a JSON document.

use super::{Converged, Convergence};
use crate::Interval;
use crate::document::FORMAT_VERSION;
use coinmc_core::Face;
use serde_json::{Map, Value, json};

/// What tight settings do as a JSON document. docs/reference/formats.md describes its fields.
pub fn document_of_convergence(found: &Convergence) -> Value {
    let settings = found.settings.iter().map(
        |setting| json!({ "key": setting.key, "usual": setting.usual, "tight": setting.tight }),
    );
    json!({
        "format_version": FORMAT_VERSION,
        "kind": "converge",
        "engine": found.engine,
        "confidence": found.confidence,
        "settings": settings.collect::<Vec<_>>(),
        "without_tosses": found.without_tosses,
        "rows": found.points.iter().map(row).collect::<Vec<_>>(),
    })
}

fn row(point: &Converged) -> Value {
    let interval = |Interval { value, lo, hi }| json!({ "value": value, "lo": lo, "hi": hi });
    let mut row = Map::new();
    row.insert("point".to_owned(), json!(point.point));
    for (name, value) in &point.parameters {
        row.insert(name.to_string(), json!(value));
    }
    for face in Face::ALL {
        let index = face as usize;
        let p = &point.p[index];
        for (end, value) in [("", p.p), ("_lo", p.lo), ("_hi", p.hi)] {
            row.insert(format!("p_{}{end}", face.name()), json!(value));
        }
        row.insert(
            format!("shift_{}", face.name()),
            interval(point.shifts[index]),
        );
        row.insert(
            format!("biased_{}", face.name()),
            json!(point.is_biased[index]),
        );
    }
    row.insert("changed".to_owned(), json!(point.changed));
    row.insert("undecided".to_owned(), json!(point.undecided[0]));
    row.insert("undecided_tight".to_owned(), json!(point.undecided[1]));
    row.insert("tosses".to_owned(), json!(point.tosses));
    Value::Object(row)
}

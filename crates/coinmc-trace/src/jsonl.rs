//! Traces as JSON lines.

use crate::table::FORMAT;
use crate::trace::Trace;
use crate::{table, to_json};
use coinmc::plan::Plan;
use serde_json::{Map, Value, json};
use std::io::{self, Write};

/// Writes one object per line: one for the file, one for each toss, followed by its records.
///
/// # Errors
/// Errors of `out`.
pub fn write_jsonl(plan: &Plan, traces: &[Trace], out: &mut dyn Write) -> io::Result<()> {
    let file = json!({
        "format": FORMAT,
        "program_version": env!("CARGO_PKG_VERSION"),
        "plan_hash": plan.hash(),
        "config": plan.resolved_toml,
    });
    line("file", file, out)?;
    for trace in traces {
        line("toss", trace.to_json(plan), out)?;
        for row in table::rows(std::slice::from_ref(trace)) {
            line("record", Value::Object(to_json::record(&row)), out)?;
        }
    }
    Ok(())
}

/// Writes a line, which begins with its type.
fn line(kind: &str, value: Value, out: &mut dyn Write) -> io::Result<()> {
    let mut object = Map::new();
    object.insert("type".to_owned(), json!(kind));
    if let Value::Object(entries) = value {
        object.extend(entries);
    }
    serde_json::to_writer(&mut *out, &object)?;
    out.write_all(b"\n")
}

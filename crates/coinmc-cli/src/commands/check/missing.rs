//! What the parts of a run still lack.

use crate::exit::{Failure, Outcome};
use crate::output::{self, Console, FORMAT_VERSION, Format};
use crate::terminal::progress::Progress;
use coinmc::run::{Missing, missing};
use serde_json::{Value, json};
use std::path::PathBuf;

/// Says what none of the run directories holds.
pub(super) fn report(dirs: &[PathBuf], console: &Console) -> Result<Outcome, Failure> {
    let progress = Progress::new(*console.stderr(), true);
    let missing = missing(dirs, &progress)?;
    match console.format() {
        Format::Json => output::print_json(&to_json(missing.as_ref())),
        Format::Table => {
            let text = missing.as_ref().map(ToString::to_string);
            output::print(&format!(
                "{}\n",
                text.as_deref().unwrap_or("nothing is missing")
            ))
        }
    }
    .map_err(|error| Failure::Runtime(error.into()))?;
    Ok(match missing {
        None => Outcome::Done,
        Some(_) => Outcome::ShortOfTarget,
    })
}

/// The document of `--format json`; docs/reference/formats.md describes it.
fn to_json(missing: Option<&Missing>) -> Value {
    let chunks = missing.iter().flat_map(|missing| &missing.chunks);
    let chunks = chunks.map(
        |chunk| json!({ "point": chunk.point, "from": chunk.tosses.start, "to": chunk.tosses.end }),
    );
    let parts = missing.iter().flat_map(|missing| &missing.parts);
    let parts = parts.map(ToString::to_string);
    json!({
        "format_version": FORMAT_VERSION,
        "kind": "missing",
        "total": missing.map_or(0, |missing| missing.total),
        "parts": parts.collect::<Vec<_>>(),
        "array": missing.map_or_else(String::new, Missing::array),
        "chunks": chunks.collect::<Vec<_>>(),
    })
}

//! Merging the parts of a run.

use crate::errors;
use crate::results::Results;
use crate::supervise::supervise;
use coinmc::run::{merge as merge_parts, merge_what_is_there};
use pyo3::prelude::*;
use std::path::PathBuf;

/// The results, how many chunks are missing, the parts that these belong to, and the warnings.
type Merged = (Results, u64, Vec<String>, Vec<String>);

/// Merges parts into a new run directory; if `partial`, what parts there are.
#[pyfunction]
pub(crate) fn merge(
    py: Python<'_>,
    parts: Vec<PathBuf>,
    out: PathBuf,
    partial: bool,
) -> PyResult<Merged> {
    let (merged, warnings) = supervise(py, None, |supervision| {
        if partial {
            merge_what_is_there(&parts, &out, supervision)
        } else {
            merge_parts(&parts, &out, supervision).map(|report| (report, None))
        }
    })?;
    let (report, missing) = merged.map_err(|error| errors::run(&error))?;
    let (chunks, parts) = missing.map_or((0, vec![]), |missing| {
        let names = missing.parts.iter().map(ToString::to_string);
        (missing.total, names.collect())
    });
    Ok((Results::new(report)?, chunks, parts, warnings))
}

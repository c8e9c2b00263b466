//! Questions: do counts of real tosses agree with a model?

use crate::results::Results;
use coinmc_questions::{Model, compare as compare_counts, document_of_comparison};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// Compares counts of heads, tails and side with the points of results, each with a name; returns the JSON
/// document of the answer.
#[pyfunction]
pub(crate) fn compare(
    py: Python<'_>,
    counts: [u64; 3],
    results: Vec<(String, Py<Results>)>,
    confidence: f64,
) -> PyResult<String> {
    let runs: Vec<_> = results
        .iter()
        .map(|(name, results)| (name, results.get().table()))
        .collect();
    let models: Vec<_> = runs
        .iter()
        .flat_map(|(run, table)| table.rows.iter().map(move |row| Model { run, row }))
        .collect();
    let answer = py.detach(|| compare_counts(counts, &models, confidence));
    let answer = answer.map_err(|error| PyValueError::new_err(error.to_string()))?;
    Ok(document_of_comparison(&answer, None).to_string())
}

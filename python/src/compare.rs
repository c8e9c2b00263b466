//! Questions: do counts of real tosses agree with a model?

use crate::results::Results;
use crate::supervise::wait_for;
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
    let document = wait_for(py, move || {
        let runs = results
            .iter()
            .map(|(name, results)| (name, results.get().table()));
        let models: Vec<_> = runs
            .flat_map(|(run, table)| table.rows.iter().map(move |row| Model { run, row }))
            .collect();
        let answer = compare_counts(counts, &models, confidence);
        answer.map(|answer| document_of_comparison(&answer, None).to_string())
    })?;
    document.map_err(|error| PyValueError::new_err(error.to_string()))
}

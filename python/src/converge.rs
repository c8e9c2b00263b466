//! Questions: how far do numerical settings move the probabilities?

use crate::question::{self, Source};
use coinmc_questions::{QuestionError, converge as answer, document_of_convergence};
use pyo3::prelude::*;
use std::num::NonZeroUsize;

/// What is asked, as Python says it.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct AskedConvergence {
    source: Source,
    overrides: Vec<String>,
    tosses: u64,
    threads: Option<NonZeroUsize>,
}

/// Tosses every point with tight settings, too; returns the JSON document of the answer.
#[pyfunction]
#[pyo3(signature = (asked, progress=None))]
pub(crate) fn converge(
    py: Python<'_>,
    asked: AskedConvergence,
    progress: Option<Py<PyAny>>,
) -> PyResult<String> {
    let (_, template) = question::template(&asked.source, &asked.overrides)?;
    question::answered(py, asked.threads, progress, |workers| {
        let found = answer(&template, asked.tosses, workers)?;
        Ok::<_, QuestionError>(document_of_convergence(&found).to_string())
    })
}

//! Questions: how rare is a face?

use crate::question::{self, Source};
use coinmc_questions::{HowRare, QuestionError, document_of_rare, how_rare};
use pyo3::prelude::*;
use std::num::NonZeroUsize;

/// What is asked, as Python says it.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct AskedRare {
    source: Source,
    overrides: Vec<String>,
    face: String,
    relative_error: f64,
    max_tosses: u64,
    threads: Option<NonZeroUsize>,
}

/// Estimates the probability of a rare face; returns the JSON document of the answer.
#[pyfunction]
#[pyo3(signature = (asked, progress=None))]
pub(crate) fn rare(
    py: Python<'_>,
    asked: AskedRare,
    progress: Option<Py<PyAny>>,
) -> PyResult<String> {
    let (_, template) = question::template(&asked.source, &asked.overrides)?;
    let question = HowRare {
        face: question::face(&asked.face)?,
        relative_error: asked.relative_error,
        max_tosses: asked.max_tosses,
    };
    question::answered(py, asked.threads, progress, |workers| {
        let answer = how_rare(&template, &question, workers)?;
        Ok::<_, QuestionError>(document_of_rare(&answer).to_string())
    })
}

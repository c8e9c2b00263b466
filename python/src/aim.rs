//! Questions: which launch forces a face?

use crate::question::{self, Source};
use coinmc_questions::{Aim, Parameter, QuestionError, aim as answer, document_of_aim, picture};
use pyo3::prelude::*;
use std::num::NonZeroUsize;

/// What is asked, as Python says it.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct AskedAim {
    source: Source,
    overrides: Vec<String>,
    face: String,
    /// Key, from, to, number of values.
    over: Vec<(String, f64, f64, usize)>,
    tosses: u64,
    final_tosses: u64,
    clumsiness: Vec<f64>,
    threads: Option<NonZeroUsize>,
}

/// Finds the launches that force a face; returns the JSON document of the answer, with the `picture`.
#[pyfunction]
#[pyo3(signature = (asked, progress=None))]
pub(crate) fn aim(
    py: Python<'_>,
    asked: AskedAim,
    progress: Option<Py<PyAny>>,
) -> PyResult<String> {
    let (_, mut template) = question::template(&asked.source, &asked.overrides)?;
    for (key, ..) in &asked.over {
        template = template.with_typed(key, "over", key);
    }
    let parameters = asked.over.into_iter();
    let question = Aim {
        face: question::face(&asked.face)?,
        parameters: parameters
            .map(|(key, from, to, values)| Parameter {
                key,
                from,
                to,
                values,
            })
            .collect(),
        tosses: asked.tosses,
        final_tosses: asked.final_tosses,
        clumsiness: asked.clumsiness,
    };
    question::answered(py, asked.threads, progress, |workers| {
        let answer = answer(&template, &question, workers)?;
        let mut document = document_of_aim(&answer);
        document["picture"] = picture(&answer).into();
        Ok::<_, QuestionError>(document.to_string())
    })
}

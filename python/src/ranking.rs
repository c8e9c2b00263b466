//! Questions: which unknown matters most?

use crate::question::{self, Source};
use coinmc_questions::{
    QuestionError, Rank, Unknown, document_of_ranking, picture_of_ranking, rank as answer,
};
use pyo3::prelude::*;
use std::num::NonZeroUsize;

/// What is asked, as Python says it.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct AskedRank {
    source: Source,
    overrides: Vec<String>,
    face: String,
    /// Key, from, to; `None` for all that the everyday scene assumes.
    over: Option<Vec<(String, f64, f64)>>,
    samples: u64,
    tosses: u64,
    threads: Option<NonZeroUsize>,
}

/// Ranks unknown numbers; returns the JSON document of the answer, with the `picture`.
#[pyfunction]
#[pyo3(signature = (asked, progress=None))]
pub(crate) fn rank(
    py: Python<'_>,
    asked: AskedRank,
    progress: Option<Py<PyAny>>,
) -> PyResult<String> {
    let (scene, mut template) = question::template(&asked.source, &asked.overrides)?;
    for (key, ..) in asked.over.iter().flatten() {
        template = template.with_typed(key, "over", key);
    }
    let unknowns = match (asked.over, scene) {
        (Some(over), _) => {
            let unknown = |(key, from, to)| Unknown { key, from, to };
            over.into_iter().map(unknown).collect()
        }
        (None, Some(scene)) => question::unknowns(&scene, &asked.overrides)?,
        (None, None) => vec![],
    };
    let question = Rank {
        face: question::face(&asked.face)?,
        unknowns,
        samples: asked.samples,
        tosses: asked.tosses,
    };
    question::answered(py, asked.threads, progress, |workers| {
        let ranking = answer(&template, &question, workers)?;
        let mut document = document_of_ranking(&ranking);
        document["picture"] = picture_of_ranking(&ranking).into();
        Ok::<_, QuestionError>(document.to_string())
    })
}

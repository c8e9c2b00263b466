//! Questions: at which value of a parameter has a face a given probability?

use crate::errors;
use crate::plan::parsed;
use crate::question::{self, Source};
use coinmc_questions::assumptions::effects;
use coinmc_questions::scenes::EverydayScene;
use coinmc_questions::{
    Question, QuestionError, Size, Template, Workers, document, fair as answer,
};
use pyo3::prelude::*;
use std::num::NonZeroUsize;

/// What is asked, as Python says it.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Asked {
    source: Source,
    overrides: Vec<String>,
    parameter: String,
    between: Option<[f64; 2]>,
    face: String,
    target: f64,
    half_width: f64,
    max_tosses: u64,
    numerical_tosses: u64,
    assumption_tosses: u64,
    diameter_m: Option<f64>,
    volume_m3: Option<f64>,
    threads: Option<NonZeroUsize>,
}

impl Asked {
    fn template(&self) -> PyResult<(Option<EverydayScene>, Template)> {
        let (scene, template) = question::template(&self.source, &self.overrides)?;
        let size = match (self.diameter_m, self.volume_m3) {
            (Some(diameter), _) => Size::Diameter(diameter),
            (None, Some(volume)) => Size::Volume(volume),
            (None, None) => Size::OfConfig,
        };
        let template = template.with_size(size);
        let template = template.map_err(|error| errors::question(&error))?;
        let key = &self.parameter;
        Ok((scene, template.with_typed(key, "parameter", key)))
    }

    fn question(&self) -> PyResult<Question> {
        Ok(Question {
            key: self.parameter.clone(),
            range: self.between,
            face: question::face(&self.face)?,
            target: self.target,
            half_width: self.half_width,
            max_tosses: self.max_tosses,
            numerical_tosses: self.numerical_tosses,
        })
    }

    /// The answer as a JSON document.
    fn answer(
        &self,
        (scene, template): (Option<EverydayScene>, &Template),
        question: &Question,
        workers: &Workers<'_>,
    ) -> Result<String, QuestionError> {
        let fair = answer(template, question, workers)?;
        let overrides = parsed(&self.overrides).unwrap_or_default();
        let root = match &fair.curves[..] {
            [curve] => curve.roots().next(),
            _ => None,
        };
        let mut found = vec![];
        if let (Some(scene), Some(root)) = (scene, root)
            && self.assumption_tosses > 0
        {
            let sized = self.diameter_m.or(self.volume_m3).is_some();
            let assumed = scene.assumed(&overrides).into_iter();
            let assumed = assumed.filter(|assumed| !(sized && assumed.key == "coin.radius_m"));
            let tosses = self.assumption_tosses;
            found = effects(template, &fair, root, assumed, tosses, workers)?;
        }
        Ok(document(&fair, (scene.as_ref(), &overrides), &found).to_string())
    }
}

/// Answers a question; returns the JSON document of the answer.
#[pyfunction]
#[pyo3(signature = (asked, progress=None))]
pub(crate) fn fair(py: Python<'_>, asked: Asked, progress: Option<Py<PyAny>>) -> PyResult<String> {
    let (scene, template) = asked.template()?;
    let question = asked.question()?;
    question::answered(py, asked.threads, progress, |workers| {
        asked.answer((scene, &template), &question, workers)
    })
}

/// Names and descriptions of the everyday scenes.
#[pyfunction]
pub(crate) fn scenes() -> Vec<(&'static str, &'static str)> {
    EverydayScene::ALL
        .iter()
        .map(|scene| (scene.name, scene.doc))
        .collect()
}

//! Questions: at which value of a parameter has a face a given probability?

use crate::errors;
use crate::plan::parsed;
use crate::supervise::supervise;
use coinmc::config;
use coinmc_core::Face;
use coinmc_questions::assumptions::effects;
use coinmc_questions::scenes::EverydayScene;
use coinmc_questions::{
    Question, QuestionError, Size, Template, Workers, document, fair as answer,
};
use pyo3::prelude::*;
use std::num::NonZeroUsize;
use std::path::Path;
use std::sync::atomic::Ordering::Relaxed;

/// What is asked, as Python says it.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Asked {
    /// The kind of the source ("path", "text", "dict" or "scene"), and the path, text or name.
    source: (String, String),
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
        let (kind, source) = &self.source;
        let overrides = parsed(&self.overrides)?;
        let (scene, template) = match kind.as_str() {
            "scene" => {
                let scene = EverydayScene::named(source).map_err(|e| errors::question(&e))?;
                (Some(scene), scene.template(&overrides))
            }
            "path" => {
                let text = config::read_text(Path::new(source));
                let text = text.map_err(|found| errors::config(&found))?;
                (None, Template::new(source, text, &overrides))
            }
            "text" => (None, Template::new("TOML text", source, &overrides)),
            _ => (
                None,
                Template::new("config from a dict", source, &overrides),
            ),
        };
        let size = match (self.diameter_m, self.volume_m3) {
            (Some(diameter), _) => Size::Diameter(diameter),
            (None, Some(volume)) => Size::Volume(volume),
            (None, None) => Size::OfConfig,
        };
        let template = template.with_size(size);
        Ok((scene, template.map_err(|error| errors::question(&error))?))
    }

    fn question(&self) -> PyResult<Question> {
        let face = Face::ALL.into_iter().find(|face| face.name() == self.face);
        let unknown = || errors::value("the face must be heads, tails or side");
        Ok(Question {
            key: self.parameter.clone(),
            range: self.between,
            face: face.ok_or_else(unknown)?,
            target: self.target,
            half_width: self.half_width,
            max_tosses: self.max_tosses,
            numerical_tosses: self.numerical_tosses,
        })
    }

    /// Whether a number is given, and so not assumed.
    fn says(&self, key: &str) -> bool {
        let sized = self.diameter_m.or(self.volume_m3).is_some();
        let overrides = parsed(&self.overrides).unwrap_or_default();
        (sized && key == "coin.radius_m") || overrides.iter().any(|set| set.is_about(key))
    }

    /// The answer as a JSON document.
    fn answer(
        &self,
        (scene, template): (Option<EverydayScene>, &Template),
        question: &Question,
        workers: &Workers<'_>,
    ) -> Result<String, QuestionError> {
        let fair = answer(template, question, workers)?;
        let root = match &fair.curves[..] {
            [curve] => curve.roots().next(),
            _ => None,
        };
        let mut found = vec![];
        if let (Some(scene), Some(root)) = (scene, root)
            && self.assumption_tosses > 0
        {
            let assumed = scene.assumptions().into_iter();
            let assumed = assumed.filter(|assumed| !self.says(assumed.key));
            let tosses = self.assumption_tosses;
            found = effects(template, &fair, root, assumed, tosses, workers)?;
        }
        Ok(document(&fair, scene.as_ref(), &found).to_string())
    }
}

/// Answers a question; returns the JSON document of the answer.
#[pyfunction]
#[pyo3(signature = (asked, progress=None))]
pub(crate) fn fair(py: Python<'_>, asked: Asked, progress: Option<Py<PyAny>>) -> PyResult<String> {
    let (scene, template) = asked.template()?;
    let question = asked.question()?;
    let (answered, _) = supervise(py, progress, |supervision| {
        let workers = Workers {
            threads: asked.threads,
            cancel: &supervision.stop,
            made: &|tosses| {
                supervision.done.fetch_add(tosses, Relaxed);
            },
        };
        asked.answer((scene, &template), &question, &workers)
    })?;
    answered.map_err(|error| errors::question(&error))
}

/// Names and descriptions of the everyday scenes.
#[pyfunction]
pub(crate) fn scenes() -> Vec<(&'static str, &'static str)> {
    EverydayScene::ALL
        .iter()
        .map(|scene| (scene.name, scene.doc))
        .collect()
}

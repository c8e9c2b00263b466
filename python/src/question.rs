//! What all questions share: where the scene comes from, and how long work is watched.

use crate::errors;
use crate::plan::parsed;
use crate::supervise::supervise;
use coinmc::config;
use coinmc_core::Face;
use coinmc_questions::scenes::EverydayScene;
use coinmc_questions::{DesignError, Template, Unknown, Workers};
use pyo3::prelude::*;
use std::num::NonZeroUsize;
use std::path::Path;
use std::sync::atomic::Ordering::Relaxed;

/// Where a scene comes from: the kind of the source ("path", "text", "dict" or "scene"), and the path,
/// text or name.
pub(crate) type Source = (String, String);

/// The template of a question, and the everyday scene that it is, if so.
pub(crate) fn template(
    (kind, source): &Source,
    overrides: &[String],
) -> PyResult<(Option<EverydayScene>, Template)> {
    let overrides = parsed(overrides)?;
    Ok(match kind.as_str() {
        "scene" => {
            let scene = EverydayScene::named(source).map_err(|error| errors::question(&error))?;
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
    })
}

/// What an everyday scene assumes and nothing says otherwise.
pub(crate) fn unknowns(scene: &EverydayScene, overrides: &[String]) -> PyResult<Vec<Unknown>> {
    let overrides = parsed(overrides)?;
    Ok(scene
        .assumed(&overrides)
        .into_iter()
        .map(Unknown::from)
        .collect())
}

/// The face of a name.
pub(crate) fn face(name: &str) -> PyResult<Face> {
    Face::named(name).ok_or_else(|| errors::value("the face must be heads, tails or side"))
}

/// Answers a question on other threads while Python may stop it and is told how far it is.
pub(crate) fn answered<T: Send, E: Into<DesignError> + Send>(
    py: Python<'_>,
    threads: Option<NonZeroUsize>,
    progress: Option<Py<PyAny>>,
    answer: impl FnOnce(&Workers<'_>) -> Result<T, E> + Send,
) -> PyResult<T> {
    let answered = working(py, threads, progress, answer)?;
    answered.map_err(|error| match error.into() {
        DesignError::Question(error) => errors::question(&error),
        error => errors::value(error),
    })
}

/// Works on other threads while Python may stop it and is told how far it is.
pub(crate) fn working<T: Send>(
    py: Python<'_>,
    threads: Option<NonZeroUsize>,
    progress: Option<Py<PyAny>>,
    work: impl FnOnce(&Workers<'_>) -> T + Send,
) -> PyResult<T> {
    let (worked, _) = supervise(py, progress, |supervision| {
        work(&Workers {
            threads,
            cancel: &supervision.stop,
            made: &|tosses| {
                supervision.done.fetch_add(tosses, Relaxed);
            },
        })
    })?;
    Ok(worked)
}

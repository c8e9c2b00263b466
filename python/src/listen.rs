//! Coins in sound recordings.

use crate::calibrate::{observations, raised};
use crate::errors;
use crate::plan::parsed;
use crate::question::{Source, working};
use coinmc_listen::{Effort, Heard, Kind, ListenError, Told, document};
use coinmc_questions::Workers;
use pyo3::prelude::*;
use std::num::NonZeroUsize;
use std::path::PathBuf;

/// What is asked, as Python says it.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct AskedListening {
    files: Vec<PathBuf>,
    source: Option<Source>,
    overrides: Vec<String>,
    folder: String,
    of: Option<String>,
    surfaces: u64,
    seed: u64,
    threads: Option<NonZeroUsize>,
}

impl AskedListening {
    fn kind(&self) -> PyResult<Option<Kind>> {
        match self.of.as_deref() {
            None => Ok(None),
            Some("drop") => Ok(Some(Kind::Drop)),
            Some("spin") => Ok(Some(Kind::Whirr)),
            Some(_) => Err(errors::value("of must be \"drop\", \"spin\" or None")),
        }
    }

    /// The JSON document of what is heard.
    fn listen(&self, kind: Option<Kind>, workers: &Workers<'_>) -> Result<String, ListenError> {
        let observed = self.source.as_ref();
        let observed = observed.map(|source| observations(source, &self.overrides, &self.folder));
        let observed = observed.transpose()?;
        let scene = observed
            .as_ref()
            .map(|observed| &observed.plan.points[0].scene);
        let heard = Heard::of_files(&self.files, scene, kind)?;
        let Some(observed) = &observed else {
            return Ok(document(&heard, None).to_string());
        };
        let effort = Effort {
            surfaces: self.surfaces,
            seed: self.seed,
        };
        let told = Told::of(&heard, observed, effort, workers)?;
        Ok(document(&heard, Some((&told, observed))).to_string())
    }
}

/// Listens to recordings; returns the JSON document of what they tell.
#[pyfunction]
#[pyo3(signature = (asked, progress=None))]
pub(crate) fn listen(
    py: Python<'_>,
    asked: AskedListening,
    progress: Option<Py<PyAny>>,
) -> PyResult<String> {
    parsed(&asked.overrides)?;
    let kind = asked.kind()?;
    let heard = working(py, asked.threads, progress, |workers| {
        asked.listen(kind, workers)
    })?;
    heard.map_err(|error| match error {
        ListenError::Calibration(error) => raised(error),
        ListenError::Question(error) => errors::question(&error),
        error => errors::value(error),
    })
}

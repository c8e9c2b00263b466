//! Claims, public data sets and engines, each with its verdict.

use crate::errors;
use crate::question;
use coinmc_questions::QuestionError;
use coinmc_validate::{Options, Size, ValidateError, document, flat_rows, validate as validated};
use pyo3::prelude::*;
use std::num::NonZeroUsize;
use std::path::PathBuf;

/// What is asked, as Python says it.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct AskedValidation {
    only: Vec<String>,
    full: bool,
    seed: u64,
    out: Option<PathBuf>,
    threads: Option<NonZeroUsize>,
}

/// Validates; returns the JSON documents of the result and of its rows.
#[pyfunction]
#[pyo3(signature = (asked, progress=None))]
pub(crate) fn validate(
    py: Python<'_>,
    asked: AskedValidation,
    progress: Option<Py<PyAny>>,
) -> PyResult<(String, String)> {
    let options = Options {
        size: if asked.full { Size::Full } else { Size::Quick },
        only: &asked.only,
        seed: asked.seed,
        out: asked.out.as_deref(),
        build: coinmc_build::BUILD,
    };
    let found = question::answered(py, asked.threads, progress, |workers| {
        match validated(&options, workers) {
            // what a question cannot say is told below
            Err(ValidateError::Stopped) => Err(QuestionError::Stopped),
            Err(ValidateError::Run(error)) => Err(QuestionError::Run(error)),
            Err(ValidateError::Question(error)) => Err(error),
            Err(ValidateError::Config(found)) => Err(QuestionError::Config(found)),
            Err(ValidateError::Key(error)) => Err(QuestionError::Key(error)),
            found => Ok(found),
        }
    })?;
    let found = found.map_err(errors::value)?;
    let document = document(&found);
    Ok((document.to_string(), flat_rows(&document).to_string()))
}

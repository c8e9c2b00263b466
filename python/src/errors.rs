//! Conversion of Rust errors to the exceptions of the Python package.

use coinmc::config::Diagnostics;
use coinmc::run::RunError;
use coinmc_film::text::Diagnostics as FilmDiagnostics;
use coinmc_questions::QuestionError;
use coinmc_recording::Error as RecordingError;
use coinmc_trace::TraceError;
use pyo3::PyErr;
use pyo3::exceptions::{PyFileExistsError, PyOSError, PyValueError};

mod python {
    #![allow(missing_docs)] // documented in Python

    pyo3::import_exception!(coinmc._errors, ConfigError);
    pyo3::import_exception!(coinmc._errors, RunError);
    pyo3::import_exception!(coinmc._errors, TraceError);
    pyo3::import_exception!(coinmc._errors, FilmError);
}

/// A problem: source, line, column, message, help.
type Problem = (String, usize, usize, String, Option<String>);

/// The message of the command line, with carets, and the list of problems.
pub(crate) fn config(found: &Diagnostics) -> PyErr {
    let problems = found.problems().iter().map(|problem| -> Problem {
        let (message, help) = (problem.message.clone(), problem.help.clone());
        let source = problem.source.clone();
        (source, problem.line, problem.column, message, help)
    });
    let problems: Vec<Problem> = problems.collect();
    python::ConfigError::new_err((found.render(false), problems))
}

/// The same for the text of a film.
pub(crate) fn footage(found: &FilmDiagnostics) -> PyErr {
    let problems = found.problems().iter().map(|problem| -> Problem {
        let (message, help) = (problem.message.clone(), problem.help.clone());
        let file = problem.file.clone();
        (file, problem.line, problem.column, message, help)
    });
    let problems: Vec<Problem> = problems.collect();
    python::FilmError::new_err((found.render(false), problems))
}

/// Why drops cannot be fitted.
pub(crate) fn film(error: impl ToString) -> PyErr {
    python::FilmError::new_err((error.to_string(), Vec::<Problem>::new()))
}

/// Why a run stopped.
pub(crate) fn run(error: &RunError) -> PyErr {
    python::RunError::new_err(error.to_string())
}

/// Why a robot's journal cannot be read.
#[cfg(unix)]
pub(crate) fn journal(error: impl ToString) -> PyErr {
    python::RunError::new_err(error.to_string())
}

/// Why a question has no answer.
pub(crate) fn question(error: &QuestionError) -> PyErr {
    match error {
        QuestionError::Config(found) => config(found),
        QuestionError::Run(error) => run(error),
        QuestionError::Engine(_) | QuestionError::Thread(_) => {
            python::RunError::new_err(error.to_string())
        }
        _ => value(error),
    }
}

/// Why there is no trace.
pub(crate) fn trace(error: &TraceError) -> PyErr {
    python::TraceError::new_err(error.to_string())
}

/// Why a file cannot be written.
pub(crate) fn file(error: &RecordingError) -> PyErr {
    match error {
        RecordingError::Exists { .. } => PyFileExistsError::new_err(error.to_string()),
        _ => PyOSError::new_err(error.to_string()),
    }
}

/// An argument is invalid.
pub(crate) fn value(error: impl ToString) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// An override is malformed.
pub(crate) fn overriding(error: impl ToString) -> PyErr {
    python::ConfigError::new_err((error.to_string(), Vec::<Problem>::new()))
}

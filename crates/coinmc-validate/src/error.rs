//! Why a validation has no result.

use coinmc::config::{Diagnostics, OverrideError};
use coinmc::run::RunError;
use coinmc_questions::QuestionError;
use thiserror::Error;

/// Why a validation has no result.
#[derive(Debug, Error)]
pub enum ValidateError {
    /// There is no claim or data set of this name.
    #[error("there is no claim or data set `{name}`{}: known are {known}", nearest.map_or(String::new(), |near| format!(" (did you mean `{near}`?)")))]
    Unknown {
        /// The name given.
        name: String,
        /// The nearest name.
        nearest: Option<&'static str>,
        /// All names.
        known: String,
    },
    /// It was stopped.
    #[error("stopped")]
    Stopped,
    /// A run failed: disk full, or a directory of another validation.
    #[error(transparent)]
    Run(#[from] RunError),
    /// A thread cannot be started, or two samples cannot be compared.
    #[error(transparent)]
    Question(#[from] QuestionError),
    /// No thread can be started.
    #[error("cannot start a thread: {0}")]
    Thread(std::io::Error),
    /// A config of this crate has problems: a mistake in the program.
    #[error("a config of the validation has problems:\n{0}")]
    Config(Diagnostics),
    /// So has a key in it.
    #[error(transparent)]
    Key(OverrideError),
}

impl From<Diagnostics> for ValidateError {
    fn from(diagnostics: Diagnostics) -> Self {
        Self::Config(diagnostics)
    }
}

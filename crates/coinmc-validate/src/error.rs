//! Why a validation has no result.

use coinmc::config::{Diagnostics, OverrideError};
use coinmc::run::RunError;
use coinmc_questions::QuestionError;
use std::path::PathBuf;
use thiserror::Error;

/// Why a validation has no result.
#[derive(Debug, Error)]
pub enum ValidateError {
    /// There are no claims or data sets of these names.
    #[error("there is no claim or data set {}; known are {known}", names.join(", "))]
    Unknown {
        /// The names given, each with the nearest one that is known, as text.
        names: Vec<String>,
        /// All names that are known.
        known: String,
    },
    /// The directory that is to keep the tosses holds something else.
    #[error(
        "{} holds {found}, which is not of a validation. Choose a new or empty directory",
        dir.display()
    )]
    OtherDirectory {
        /// The directory.
        dir: PathBuf,
        /// What was found in it.
        found: String,
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

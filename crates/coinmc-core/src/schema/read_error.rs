//! Why checked values describe nothing.

use crate::EngineError;
use thiserror::Error;

/// Values that are valid by themselves but describe nothing together, with the key to blame.
///
/// # Example
/// ```
/// use coinmc_core::schema::ReadError;
/// let error = ReadError::new("an empty range").at("to").at("height_m");
/// assert_eq!(error.path().collect::<Vec<_>>(), ["height_m", "to"]);
/// assert_eq!(error.to_string(), "an empty range");
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{reason}")]
pub struct ReadError {
    reason: String,
    help: Option<&'static str>,
    /// Keys, innermost first.
    path: Vec<&'static str>,
    is_mismatch: bool,
}

impl ReadError {
    /// An error that blames the whole table.
    pub fn new(reason: impl Into<String>) -> Self {
        Self {
            reason: reason.into(),
            help: None,
            path: Vec::new(),
            is_mismatch: false,
        }
    }

    /// The same error with a remedy.
    pub fn with_help(mut self, help: &'static str) -> Self {
        self.help = Some(help);
        self
    }

    /// The same error, blamed on a key of the enclosing table.
    pub fn at(mut self, key: &'static str) -> Self {
        self.path.push(key);
        self
    }

    /// The remedy, if there is one.
    pub fn help(&self) -> Option<&'static str> {
        self.help
    }

    /// Whether the values do not follow their schema: see [`EngineError::mismatch`].
    pub fn is_mismatch(&self) -> bool {
        self.is_mismatch
    }

    /// The key to blame: the keys that lead to it, outermost first.
    pub fn path(&self) -> impl Iterator<Item = &'static str> {
        self.path.iter().rev().copied()
    }
}

impl From<EngineError> for ReadError {
    fn from(error: EngineError) -> Self {
        Self {
            is_mismatch: error.is_mismatch(),
            ..Self::new(error.to_string())
        }
    }
}

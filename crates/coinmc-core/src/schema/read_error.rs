//! Errors of checked values that contradict each other.

use crate::EngineError;
use thiserror::Error;

/// Values that are individually valid but contradict each other, with the key at fault.
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
    /// An error of the whole table.
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

    /// The same error, at a key of the enclosing table.
    pub fn at(mut self, key: &'static str) -> Self {
        self.path.push(key);
        self
    }

    /// The remedy, if there is one.
    pub fn help(&self) -> Option<&'static str> {
        self.help
    }

    /// Whether the values do not match their schema: see [`EngineError::mismatch`].
    pub fn is_mismatch(&self) -> bool {
        self.is_mismatch
    }

    /// The path of the key at fault, outermost key first.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_keeps_its_remedy_at_each_key() {
        let error = ReadError::new("too thin");
        assert_eq!(error.help(), None);
        let helped = error.with_help("make it thicker").at("ratio").at("coin");
        assert_eq!(helped.help(), Some("make it thicker"));
        assert_eq!(helped.to_string(), "too thin");
    }

    #[test]
    fn a_mismatch_of_schema_and_reader_remains_one() {
        let read = |error| ReadError::from(error).at("engine");
        assert!(read(EngineError::mismatch("no such key")).is_mismatch());
        assert!(!read(EngineError::new("too large")).is_mismatch());
        assert!(!ReadError::new("too large").is_mismatch());
    }
}

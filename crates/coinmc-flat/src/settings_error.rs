//! Why settings are rejected.

use coinmc_core::schema::OutOfRange;
use thiserror::Error;

/// Invalid settings.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum SettingsError {
    /// A setting, or a parameter of the law of impact, is out of its range.
    #[error(transparent)]
    OutOfRange(#[from] OutOfRange),
    /// Gaek & Sukhov's law has no friction.
    #[error("Gaek & Sukhov's law has no friction: friction must be 0, not {0}")]
    Friction(f64),
}

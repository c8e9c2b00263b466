//! Why there is no calibration.

use crate::settings::OutOfRange;
use coinmc::config::Diagnostics;
use coinmc_core::{EngineError, SurfaceError};
use coinmc_questions::QuestionError;
use thiserror::Error;

/// Why there is no calibration.
#[derive(Debug, Error)]
pub enum CalibrationError {
    /// The config has problems, or a measurement contradicts its prior.
    #[error("the config has problems:\n{0}")]
    Config(Diagnostics),
    /// The config is a sweep.
    #[error("a calibration is about one scene, but the config sweeps {0}")]
    Swept(String),
    /// The engine makes no tosses.
    #[error("a closed form has no surface to calibrate: choose an engine that tosses")]
    NoTosses,
    /// The first contact decides.
    #[error("with landing = \"adhesive\" the surface does not matter: use landing = \"bouncing\"")]
    Adhesive,
    /// Nothing was measured.
    #[error(
        "nothing is measured: add tables such as [[counts]], [[tilt]] or [[roll_out]] to the config"
    )]
    NothingMeasured,
    /// Numbers of the work are out of range.
    #[error("{}", lines(.0))]
    OutOfRange(Vec<OutOfRange>),
    /// Too few tosses showed a face.
    #[error(
        "too few tosses of {0} end with a face to calibrate anything: {1} of {2} are undecided or left the table"
    )]
    Undecided(String, u64, u64),
    /// The engine refuses a surface.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// The parameters make no surface.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// Tosses cannot be made, or were stopped.
    #[error(transparent)]
    Question(#[from] QuestionError),
    /// The fit of the probabilities failed.
    #[error("the probabilities of {0} cannot be fitted")]
    Fit(String),
    /// The posterior is too narrow, or lies too far out in the prior, for its draws.
    #[error(
        "the measurements leave so little of the prior that the posterior is worth only {0:.0} independent draws, and \
         {least} are needed: check the errors that are stated, or state a narrower [prior]", least = crate::posterior::LEAST
    )]
    Unresolved(f64),
    /// The measurements exclude each other.
    #[error("no surface agrees with all measurements: {0}")]
    Contradiction(String),
}

impl From<Diagnostics> for CalibrationError {
    fn from(diagnostics: Diagnostics) -> Self {
        Self::Config(diagnostics)
    }
}

/// One of them a line.
fn lines(several: &[OutOfRange]) -> String {
    let lines = several.iter().map(OutOfRange::to_string);
    lines.collect::<Vec<_>>().join("\n")
}

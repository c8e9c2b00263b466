//! Why a toss cannot be traced.

use coinmc_core::EngineError;
use thiserror::Error;

/// Why there is no trace, or no file of it.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum TraceError {
    /// The plan has fewer points.
    #[error(
        "there is no point {point}: this config has {points}, numbered from 0 (the column \
         `point` of the results)"
    )]
    NoSuchPoint {
        /// The point asked for.
        point: usize,
        /// Points there are.
        points: usize,
    },
    /// The run makes fewer tosses.
    #[error(
        "there is no toss {toss}: this config makes {tosses} a point, numbered from 0 (see [stop])"
    )]
    NoSuchToss {
        /// The toss asked for.
        toss: u64,
        /// Tosses a point.
        tosses: u64,
    },
    /// A closed form makes no tosses.
    #[error(
        "point {point} has the engine `{engine}`, a closed form that makes no tosses: there is \
         nothing to trace"
    )]
    NoTraces {
        /// The point.
        point: usize,
        /// Its engine.
        engine: &'static str,
    },
    /// The rate is not one.
    #[error("a rate of samples lies between 0 and 1e9 a second, not {0}")]
    Rate(f64),
    /// An engine does not accept its settings.
    #[error("point {point}: {source}")]
    Settings {
        /// Index of the point.
        point: usize,
        /// What the engine says.
        source: EngineError,
    },
}

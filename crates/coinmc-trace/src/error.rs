//! Errors of tracing.

use coinmc_core::EngineError;
use thiserror::Error;

/// Why a toss cannot be traced.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum TraceError {
    /// The plan has no such point.
    #[error(
        "there is no point {point}: this config has {points}, numbered from 0 (the column \
         `point` of the results)"
    )]
    NoSuchPoint {
        /// The requested point.
        point: usize,
        /// Number of points.
        points: usize,
    },
    /// The plan has no such toss.
    #[error(
        "there is no toss {toss}: this config has {tosses} per point, numbered from 0 (see [stop])"
    )]
    NoSuchToss {
        /// The requested toss.
        toss: u64,
        /// Number of tosses per point.
        tosses: u64,
    },
    /// The engine is a closed form, without tosses.
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
    /// The sampling rate is out of range.
    #[error("a sampling rate lies between 0 and 1e9 per second, not {0}")]
    Rate(f64),
    /// An engine rejects its settings.
    #[error("point {point}: {source}")]
    Settings {
        /// Index of the point.
        point: usize,
        /// The engine's error.
        source: EngineError,
    },
}

//! Errors of fits.

use thiserror::Error;

/// Why drops cannot be fitted.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum FitError {
    /// No drop, or too many.
    #[error("a fit takes 1 to 64 drops, not {0}")]
    Drops(usize),
    /// The confidence lies outside (0, 1).
    #[error("the confidence must lie between 0 and 1, not {0}")]
    Confidence(f64),
    /// A value to start from lies outside its range.
    #[error("restitution must lie from 0 to 1 and friction from 0 to 10")]
    OutOfRange,
    /// A drop has too many frames.
    #[error("{name}: {frames} frames are too many, at most {max} are allowed: export fewer")]
    TooLong {
        /// The drop.
        name: String,
        /// Its number of frames.
        frames: usize,
        /// The greatest number allowed.
        max: usize,
    },
    /// All drops together need too much memory.
    #[error("{frames} frames are too many for one fit: fit fewer drops, or fewer frames of each")]
    TooLarge {
        /// Number of frames of all drops.
        frames: usize,
    },
    /// The film does not begin with a flight that is long enough.
    #[error(
        "{name}: the film must begin with at least {least} frames of free flight in which y and θ \
         are marked"
    )]
    NoFlight {
        /// The drop.
        name: String,
        /// Number of frames needed.
        least: usize,
    },
    /// The search found no minimum.
    #[error("no motion under the law {law} resembles the film: check coin, units and angle")]
    NothingFound {
        /// The law.
        law: &'static str,
    },
    /// As many values are fitted as there are points, or more.
    #[error(
        "{points} points are too few for {fitted} fitted values: check coin, units, angle and floor, \
         or fit more of the film"
    )]
    TooFew {
        /// Number of points that count.
        points: usize,
        /// Number of fitted values.
        fitted: usize,
    },
    /// The computation failed at the minimum.
    #[error("the fit failed: check coin, units, angle and floor")]
    Lost,
}

//! What a reader of a fit ought to know.

use crate::drop::Coordinate;
use crate::parameter::Parameter;
use std::fmt;

/// Something that a fit cannot tell, or that speaks against it.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Remark {
    /// Nothing hits the surface within the frames that count.
    NoImpact {
        /// The drop.
        drop: String,
    },
    /// The film fixes a parameter from one side only, or not at all.
    Undetermined(Parameter),
    /// The estimate stands at the end of what is possible.
    AtTheEnd(Parameter),
    /// Successive residuals resemble each other: the law, the coin or the calibration is not the
    /// film's, and the intervals are too short.
    Correlated {
        /// Of which coordinate.
        coordinate: Coordinate,
        /// Correlation of one frame with the next.
        correlation: f64,
    },
    /// Residuals that normal noise does not make.
    Outliers {
        /// How many are beyond five standard deviations.
        count: usize,
    },
}

impl fmt::Display for Remark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoImpact { drop } => write!(
                f,
                "{drop}: no impact among the frames that count, so it says nothing about the law"
            ),
            Self::Undetermined(Parameter::Friction) => f.write_str(
                "friction is not fixed from both sides: where every impact stops the slip (or none \
                 is steep enough to need it) more friction changes nothing; film drops that slip",
            ),
            Self::Undetermined(parameter) => write!(
                f,
                "{} is not fixed from both sides by these drops",
                parameter.name()
            ),
            Self::AtTheEnd(parameter) => write!(
                f,
                "{} stands at the end of its range: the law may be the wrong one",
                parameter.name()
            ),
            Self::Correlated {
                coordinate,
                correlation,
            } => write!(
                f,
                "residuals of {} go together from frame to frame (correlation {correlation:.2}): \
                 law, coin or calibration are not the film's, and the intervals are too short",
                coordinate.name()
            ),
            Self::Outliers { count } => write!(
                f,
                "{count} residuals beyond five standard deviations: if they are marking errors, \
                 use the loss huber"
            ),
        }
    }
}

//! Remarks on a fit.

use crate::drop::Coordinate;
use crate::parameter::Parameter;
use std::fmt;

/// Something that a fit cannot determine, or that casts doubt on it.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Remark {
    /// There is no impact within the frames that count.
    NoImpact {
        /// The drop.
        drop: String,
    },
    /// The film bounds a parameter on one side only, or not at all.
    Undetermined(Parameter),
    /// The estimate is at the end of its range.
    AtTheEnd(Parameter),
    /// Successive residuals are correlated: the law, the coin or the calibration is wrong, and the
    /// intervals are too short.
    Correlated {
        /// The coordinate.
        coordinate: Coordinate,
        /// Correlation between successive frames.
        correlation: f64,
    },
    /// There are outliers that normal noise does not explain.
    Outliers {
        /// Number of residuals beyond five standard deviations.
        count: usize,
    },
}

impl fmt::Display for Remark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoImpact { drop } => write!(
                f,
                "{drop}: no impact among the frames that count, so it does not test the law"
            ),
            Self::Undetermined(Parameter::Friction) => f.write_str(
                "friction is not fixed from both sides: where every impact stops the slip (or none \
                 is steep enough to need it) more friction changes nothing; film drops that slip",
            ),
            Self::Undetermined(parameter) => write!(
                f,
                "{} is not bounded on both sides by these drops",
                parameter.name()
            ),
            Self::AtTheEnd(parameter) => write!(
                f,
                "{} is at the end of its range: the law may be wrong",
                parameter.name()
            ),
            Self::Correlated {
                coordinate,
                correlation,
            } => write!(
                f,
                "residuals of {} are correlated from frame to frame ({correlation:.2}): the \
                 law, the coin or the calibration is wrong, and the intervals are too short",
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

//! Conditions of a search for tosses.

use crate::end::EndKind;
use coinmc_core::{Face, Outcome};
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// A condition on how a toss ends.
///
/// # Example
/// ```
/// use coinmc_trace::Condition;
/// use coinmc_core::Face;
/// assert_eq!("face=side".parse(), Ok(Condition::Face(Face::Side)));
/// assert!("face=edge".parse::<Condition>().is_err());
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Condition {
    /// It shows this face.
    Face(Face),
    /// It ends in this way, with any face for [`EndKind::Decided`].
    Ended(EndKind),
}

/// The text is not a condition.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error(
    "a condition is `face=heads`, `face=tails`, `face=side`, `ended=decided`, `ended=left`, \
     `ended=time_limit`, `ended=never_settles`, `ended=impact_limit` or `ended=failed`"
)]
pub struct ConditionError;

impl FromStr for Condition {
    type Err = ConditionError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let found = match text.split_once('=') {
            Some(("face", name)) => Face::named(name).map(Self::Face),
            Some(("ended", name)) => {
                let end = EndKind::ALL.into_iter().find(|end| end.name() == name);
                end.map(Self::Ended)
            }
            _ => None,
        };
        found.ok_or(ConditionError)
    }
}

impl fmt::Display for Condition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Face(face) => write!(f, "face={}", face.name()),
            Self::Ended(end) => write!(f, "ended={}", end.name()),
        }
    }
}

impl Condition {
    /// Whether an outcome meets the condition.
    pub fn holds(&self, outcome: &Outcome) -> bool {
        match self {
            Self::Face(face) => outcome.face() == Some(*face),
            Self::Ended(end) => EndKind::of(outcome.ended) == *end,
        }
    }
}

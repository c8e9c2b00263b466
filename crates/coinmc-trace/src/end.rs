//! The ways in which tosses end, and their names.

use coinmc_core::{Ended, Outcome};

/// How a toss ended, regardless of the face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EndKind {
    /// With a face.
    Decided,
    /// It left the table over its edge.
    Left,
    /// Undecided at the limit of simulated time.
    TimeLimit,
    /// Proven never to settle.
    NeverSettles,
    /// Undecided at the limit of impacts or of steps in contact.
    ImpactLimit,
    /// The computation failed (NaN).
    Failed,
}

impl EndKind {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::Decided,
        Self::Left,
        Self::TimeLimit,
        Self::NeverSettles,
        Self::ImpactLimit,
        Self::Failed,
    ];

    /// The kind of an end.
    pub fn of(ended: Ended) -> Self {
        match ended {
            Ended::Decided(_) => Self::Decided,
            Ended::Left => Self::Left,
            Ended::TimeLimit => Self::TimeLimit,
            Ended::NeverSettles => Self::NeverSettles,
            Ended::ImpactLimit => Self::ImpactLimit,
            Ended::Failed => Self::Failed,
        }
    }

    /// The name used in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Decided => "decided",
            Self::Left => "left",
            Self::TimeLimit => "time_limit",
            Self::NeverSettles => "never_settles",
            Self::ImpactLimit => "impact_limit",
            Self::Failed => "failed",
        }
    }
}

/// The face, or why there is none, as named in files.
pub fn outcome_name(outcome: &Outcome) -> &'static str {
    match outcome.face() {
        Some(face) => face.name(),
        None => EndKind::of(outcome.ended).name(),
    }
}

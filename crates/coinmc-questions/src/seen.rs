//! Tosses that were counted.

use crate::changes::{ENDS, UNDECIDED};
use coinmc::plan::Plan;
use coinmc_core::Estimate;

/// Tosses, and how many of them showed a face.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Seen {
    pub(crate) tosses: u64,
    /// Tosses that showed the face.
    pub(crate) shown: u64,
    /// Tosses of which it is not known how they end.
    pub(crate) undecided: u64,
}

impl Seen {
    /// Of the counts of all ends, those of this face.
    pub(crate) fn of(counts: [u64; ENDS], face: coinmc_core::Face) -> Self {
        Self {
            tosses: counts.iter().sum(),
            shown: counts[face as usize],
            undecided: counts[UNDECIDED],
        }
    }

    pub(crate) fn share(&self) -> f64 {
        self.shown as f64 / self.tosses as f64
    }

    pub(crate) fn add(&mut self, other: Self) {
        self.tosses += other.tosses;
        self.shown += other.shown;
        self.undecided += other.undecided;
    }

    /// The probability of the face, with the interval that the plan asks for.
    pub(crate) fn estimate(&self, plan: &Plan) -> Estimate {
        Estimate::new(
            self.shown,
            self.undecided,
            self.tosses,
            plan.confidence,
            plan.interval,
        )
    }
}

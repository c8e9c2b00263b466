//! Counts of tosses, as the search asks for them.

pub(super) use crate::seen::Seen;

/// A question to whoever tosses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sample {
    /// The value of the parameter.
    pub(super) value: f64,
    /// Number of the first toss. Tosses of one number share their random numbers, whatever the value.
    pub(super) first: u64,
    /// How many tosses.
    pub(super) tosses: u64,
}

/// Whoever tosses.
pub(super) trait Tosses {
    type Error;

    /// Counts all samples.
    fn count(&mut self, samples: &[Sample]) -> Result<Vec<Seen>, Self::Error>;
}

//! Counts of tosses, as the search asks for them.

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

/// The answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Seen {
    pub(super) tosses: u64,
    /// Tosses that showed the face.
    pub(super) shown: u64,
    /// Tosses without a face.
    pub(super) undecided: u64,
}

impl Seen {
    pub(super) fn share(&self) -> f64 {
        self.shown as f64 / self.tosses as f64
    }

    pub(super) fn add(&mut self, other: Self) {
        self.tosses += other.tosses;
        self.shown += other.shown;
        self.undecided += other.undecided;
    }
}

/// Whoever tosses.
pub(super) trait Tosses {
    type Error;

    /// Counts all samples.
    fn count(&mut self, samples: &[Sample]) -> Result<Vec<Seen>, Self::Error>;
}

//! What is counted during a toss.

use coinmc_core::{Breaks, Ended, Outcome};

/// The counters of one toss.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Counters {
    pub(crate) impacts: u32,
    pub(crate) contact_steps: u32,
    pub(crate) jams: u32,
    pub(crate) breaks: Breaks,
}

impl Counters {
    /// The outcome of a toss that ended in this way.
    pub(crate) fn outcome(&self, ended: Ended) -> Outcome {
        Outcome {
            ended,
            impacts: self.impacts,
            contact_steps: self.contact_steps,
            jams: self.jams,
            overruled: false,
            breaks: self.breaks,
            side_ending: None,
        }
    }
}

//! A recorded toss.

use crate::record::Record;
use coinmc_core::{Launch, Outcome, Scene};

/// A recorded toss.
#[derive(Debug, Clone, PartialEq)]
pub struct Trace {
    /// Index of the point in the plan.
    pub point: usize,
    /// Number of the toss.
    pub toss: u64,
    /// Name of the engine.
    pub engine: &'static str,
    /// Coin, surface and environment.
    pub scene: Scene,
    /// The launch.
    pub launch: Launch,
    /// Requested sampling rate, 1/s; 0 for events only.
    pub rate_hz: f64,
    /// The outcome, the same as in the run.
    pub outcome: Outcome,
    /// The records in order of time. The first is the launch, the last the end.
    pub records: Vec<Record>,
    /// Time of the last recorded sample, s, if the recorder was full; `None` if all are recorded.
    pub samples_until_s: Option<f64>,
    /// The same for events; the end is always recorded.
    pub events_until_s: Option<f64>,
}

impl Trace {
    /// Duration of the toss, s.
    pub fn duration_s(&self) -> f64 {
        self.records.last().map_or(0.0, |last| last.state.time_s)
    }
}

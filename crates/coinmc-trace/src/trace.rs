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
    /// Name of the engine that followed it.
    pub engine: &'static str,
    /// What was tossed, onto what.
    pub scene: Scene,
    /// How it began.
    pub launch: Launch,
    /// Samples a second asked for, 1/s; 0 for events alone.
    pub rate_hz: f64,
    /// How it ended: the same as in the run.
    pub outcome: Outcome,
    /// What was seen, in order of time. The first is the launch, the last the end.
    pub records: Vec<Record>,
    /// Where the recorder was full: no sample is recorded after this time, s. `None`: all are there.
    pub samples_until_s: Option<f64>,
    /// The same for events; the end is recorded always.
    pub events_until_s: Option<f64>,
}

impl Trace {
    /// When the toss ended, s since launch.
    pub fn duration_s(&self) -> f64 {
        self.records.last().map_or(0.0, |last| last.state.time_s)
    }
}

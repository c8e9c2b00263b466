//! Progress reports of a run.

use coinmc_core::{Estimate, Face};

/// How far a run is. For display only: none of it enters the results.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// Points that have all the tosses they need (of this part).
    pub points_done: usize,
    /// All points.
    pub points: usize,
    /// Tosses counted so far, those of an earlier run included.
    pub tosses_done: u64,
    /// Tosses the run will count in all. Where points stop at targets this is a forecast and
    /// changes.
    pub tosses_planned: u64,
    /// Of `tosses_done`, those that an earlier run had counted.
    pub tosses_reused: u64,
    /// Chunks reused from an earlier run.
    pub reused_chunks: u64,
    /// The widest arm of any face's interval at any point so far, by Wilson's formula, which is quick;
    /// `None` before the first toss.
    pub worst_half_width: Option<f64>,
    /// What the point that was counted last has shown so far; `None` before the first toss.
    pub latest: Option<Latest>,
}

/// What a point has shown so far.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Latest {
    /// The point.
    pub point: usize,
    /// The face that the targets are of; the side where they are of all.
    pub face: Face,
    /// Its probability, by Wilson's formula; where the point stops at targets, that of its pilot while it lasts.
    pub estimate: Estimate,
}

/// Receives the progress and the warnings of a run. `()` ignores both.
pub trait ProgressSink: Sync {
    /// Called at the start, once the chunks of an earlier run have been read; each time finished chunks
    /// are on the disk; and at the end.
    fn progress(&self, progress: &Progress);

    /// Called when something was wrong and has been dealt with; the text says how.
    fn warning(&self, message: &str);

    /// Called with a remark on what is done; nothing is wrong.
    fn note(&self, message: &str) {
        let _ = message;
    }
}

impl ProgressSink for () {
    fn progress(&self, _: &Progress) {}
    fn warning(&self, _: &str) {}
}

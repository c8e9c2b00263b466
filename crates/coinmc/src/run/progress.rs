//! What a run tells while it goes on.

/// How far a run is. All of it is for the eye: none of it enters the results.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// Points with all the tosses they need (of this part).
    pub points_done: usize,
    /// All points.
    pub points: usize,
    /// Tosses counted so far, those of an earlier run included.
    pub tosses_done: u64,
    /// Tosses the run will count in all. Where points stop at a half width this is a forecast and
    /// changes.
    pub tosses_planned: u64,
    /// Of `tosses_done`, those that an earlier run had counted.
    pub tosses_reused: u64,
    /// Chunks taken over from an earlier run.
    pub reused_chunks: u64,
    /// The longest arm of any face's interval at any point tossed so far (by Wilson's formula,
    /// which is quick); `None` before the first toss.
    pub worst_half_width: Option<f64>,
}

/// Who follows a run. `()` ignores everything.
pub trait ProgressSink: Sync {
    /// Called at the start, when what is left of an earlier run has been read, each time finished
    /// chunks are on the disk, and at the end.
    fn progress(&self, progress: &Progress);

    /// Something was wrong and has been dealt with; the text says how.
    fn warning(&self, message: &str);
}

impl ProgressSink for () {
    fn progress(&self, _: &Progress) {}
    fn warning(&self, _: &str) {}
}

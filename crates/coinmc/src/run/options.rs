//! How to run a plan.

use super::{Part, ProgressSink};
use std::num::NonZeroUsize;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::thread;

/// How to run a plan. None of it changes the counts.
#[derive(Clone, Copy)]
pub struct Options<'a> {
    /// The run directory: new, empty, or that of the same run.
    pub out: &'a Path,
    /// How the run directory names this build of the program: its version and commit.
    pub build: &'a str,
    /// The share of the run to do.
    pub part: Part,
    /// Threads that toss; `None` for one per core.
    pub threads: Option<NonZeroUsize>,
    /// Set it (from another thread or a signal) to stop within about 0.1 s.
    pub cancel: &'a AtomicBool,
    /// Receives the progress.
    pub sink: &'a dyn ProgressSink,
}

/// The threads asked for, or one per core.
pub(super) fn one_per_core(threads: Option<NonZeroUsize>) -> NonZeroUsize {
    let threads = threads.or_else(|| thread::available_parallelism().ok());
    threads.unwrap_or(NonZeroUsize::MIN)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn threads_are_those_asked_for_or_one_per_core() {
        let three = NonZeroUsize::new(3);
        assert_eq!(Some(one_per_core(three)), three);
        let cores = thread::available_parallelism().ok();
        assert_eq!(one_per_core(None), cores.unwrap_or(NonZeroUsize::MIN));
    }
}

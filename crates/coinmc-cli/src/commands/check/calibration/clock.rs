//! The time that work takes on this thread, whatever else the machine does.

use coinmc::run::processor_time;
use std::time::{Duration, Instant};

/// By how many times the time by the clock may be longer than that of the processor, before work that is to take
/// some time ends for the sake of whoever waits.
const PATIENCE: u32 = 4;

/// A moment.
#[derive(Debug, Clone, Copy)]
pub(super) struct Clock {
    wall: Instant,
    processor: Option<Duration>,
}

impl Clock {
    pub(super) fn now() -> Self {
        Self {
            wall: Instant::now(),
            processor: processor_time(),
        }
    }

    /// Processor time since then; by the clock where the system does not tell it.
    pub(super) fn elapsed(&self) -> Duration {
        let processor = processor_time().zip(self.processor);
        processor.map_or_else(
            || self.wall.elapsed(),
            |(now, then)| now.saturating_sub(then),
        )
    }

    /// Whether work that may take so much processor time has taken it, or far longer by the clock.
    pub(super) fn has_taken(&self, time: Duration) -> bool {
        self.elapsed() > time || self.wall.elapsed() > time * PATIENCE
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// So a busy machine makes no forecast longer.
    #[cfg(unix)]
    #[test]
    fn waiting_takes_no_time() {
        let (before, pause) = (Clock::now(), Duration::from_millis(30));
        std::thread::sleep(pause);
        assert!(before.elapsed() < pause / 2);
        assert!(!before.has_taken(pause) && before.has_taken(pause / 8));
    }
}

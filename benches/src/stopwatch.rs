//! Processor time of this thread: on a busy machine wall time counts other programs' work as well.

use std::time::{Duration, Instant};

/// Measures from its start.
#[derive(Debug, Clone, Copy)]
pub struct Stopwatch {
    wall: Instant,
    processor: Option<Duration>,
}

impl Stopwatch {
    /// Starts.
    pub fn start() -> Self {
        Self {
            wall: Instant::now(),
            processor: on_processor(),
        }
    }

    /// Seconds since the start: processor time where the system reports it, else wall time.
    pub fn seconds(&self) -> f64 {
        let spent = on_processor().zip(self.processor);
        let spent = spent.and_then(|(now, then)| now.checked_sub(then));
        spent.unwrap_or_else(|| self.wall.elapsed()).as_secs_f64()
    }
}

#[cfg(unix)]
fn on_processor() -> Option<Duration> {
    use rustix::time::{ClockId, clock_gettime};
    clock_gettime(ClockId::ThreadCPUTime).try_into().ok()
}

#[cfg(not(unix))]
fn on_processor() -> Option<Duration> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_passes_no_faster_than_on_the_wall() {
        let (watch, wall) = (Stopwatch::start(), Instant::now());
        while wall.elapsed() < Duration::from_millis(20) {}
        let (spent, passed) = (watch.seconds(), wall.elapsed().as_secs_f64());
        // the two clocks are not read at one instant
        assert!(spent > 0.0 && spent <= passed + 1e-3, "{spent} {passed}");
    }
}

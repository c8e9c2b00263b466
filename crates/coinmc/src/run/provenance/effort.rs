//! How long a chunk took.

use serde::{Deserialize, Serialize};
use std::time::{Duration, Instant};

/// The time that a chunk took on its threads, in microseconds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Effort {
    /// By the clock.
    pub(crate) wall_us: u64,
    /// Of the processor, where the system tells it.
    pub(crate) cpu_us: Option<u64>,
}

impl Effort {
    pub(crate) const NONE: Self = Self {
        wall_us: 0,
        cpu_us: Some(0),
    };

    /// The sum of two.
    pub(crate) fn and(self, other: Self) -> Self {
        let of_cpu = self.cpu_us.zip(other.cpu_us);
        Self {
            wall_us: self.wall_us.saturating_add(other.wall_us),
            cpu_us: of_cpu.map(|(one, other)| one.saturating_add(other)),
        }
    }
}

/// Runs while a chunk is computed, on the same thread.
#[derive(Debug)]
pub(crate) struct Stopwatch {
    wall: Instant,
    cpu: Option<Duration>,
}

impl Stopwatch {
    pub(crate) fn start() -> Self {
        Self {
            wall: Instant::now(),
            cpu: processor_time(),
        }
    }

    pub(crate) fn effort(&self) -> Effort {
        let of_cpu = self.cpu.zip(processor_time());
        Effort {
            wall_us: microseconds(self.wall.elapsed()),
            cpu_us: of_cpu.map(|(then, now)| microseconds(now.saturating_sub(then))),
        }
    }
}

fn microseconds(time: Duration) -> u64 {
    u64::try_from(time.as_micros()).unwrap_or(u64::MAX)
}

/// Processor time of this thread since it began; `None` where the system does not tell it.
///
/// # Example
/// ```
/// let before = coinmc::run::processor_time();
/// std::thread::sleep(std::time::Duration::from_millis(5));
/// let slept = coinmc::run::processor_time().zip(before).map(|(now, then)| now - then);
/// assert!(slept.is_none_or(|time| time.as_millis() < 5));
/// ```
#[cfg(unix)]
pub fn processor_time() -> Option<Duration> {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    let (seconds, nanoseconds) = (u64::try_from(time.tv_sec), u32::try_from(time.tv_nsec));
    Some(Duration::new(seconds.ok()?, nanoseconds.ok()?))
}

/// `None`: this system does not tell it.
#[cfg(not(unix))]
pub fn processor_time() -> Option<Duration> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn a_thread_that_sleeps_uses_no_processor() {
        let watch = Stopwatch::start();
        std::thread::sleep(Duration::from_millis(30));
        let slept = watch.effort();
        assert!(slept.wall_us >= 30_000 && slept.cpu_us.unwrap() < 20_000);
        while watch.effort().cpu_us < Some(20_000) {}
        assert!(watch.effort().wall_us >= 50_000);
    }
}

//! The clock of the link: wall time, or faster for a simulated robot.

use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

/// A clock that never goes backwards.
#[derive(Debug, Clone, Copy)]
pub struct Clock {
    origin: Instant,
    speed: f64,
}

impl Clock {
    /// A clock that starts at 0 and runs `speed` (at least 1) times as fast as wall time.
    pub fn new(speed: f64) -> Self {
        Self {
            origin: Instant::now(),
            speed: speed.max(1.0),
        }
    }

    /// Milliseconds since its start.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    pub fn now_ms(&self) -> u64 {
        // 2^53 ms are 285 000 years
        (self.origin.elapsed().as_secs_f64() * 1e3 * self.speed) as u64
    }

    /// Wall time that corresponds to a time of this clock.
    pub fn wall(&self, time: Duration) -> Duration {
        time.div_f64(self.speed)
    }
}

/// System time, milliseconds since 1970; 0 if the system's clock is set before that.
pub fn unix_ms() -> u64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH);
    since.map_or(0, |d| u64::try_from(d.as_millis()).unwrap_or(u64::MAX))
}

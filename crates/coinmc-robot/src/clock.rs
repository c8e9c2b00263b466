//! Time as the link sees it: that of the wall, or faster for a simulated robot.

use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

/// A clock that never goes back.
#[derive(Debug, Clone, Copy)]
pub struct Clock {
    origin: Instant,
    speed: f64,
}

impl Clock {
    /// A clock that begins at 0 and runs `speed` (at least 1) times as fast as the wall's.
    pub fn new(speed: f64) -> Self {
        Self {
            origin: Instant::now(),
            speed: speed.max(1.0),
        }
    }

    /// Milliseconds since it began.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    pub fn now_ms(&self) -> u64 {
        // beyond 2^53 ms lie 285 000 years
        (self.origin.elapsed().as_secs_f64() * 1e3 * self.speed) as u64
    }

    /// How long the wall's clock takes for so much of this one.
    pub fn wall(&self, time: Duration) -> Duration {
        time.div_f64(self.speed)
    }
}

/// The time of day, milliseconds since 1970; 0 on a machine whose clock stands before that.
pub fn unix_ms() -> u64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH);
    since.map_or(0, |d| u64::try_from(d.as_millis()).unwrap_or(u64::MAX))
}

//! How many tosses a worker makes at a time, and when it reports them.

use std::time::{Duration, Instant};

/// A worker reports what it has counted of a chunk that takes longer than this, as often.
const REPORT: Duration = Duration::from_millis(500);
/// About how long a stretch of tosses takes.
const STRETCH: Duration = Duration::from_millis(250);
/// Tosses of the first stretch, as nothing is known of the speed: few, so that something is soon known of the
/// slowest scene.
const FIRST: u64 = 1 << 6;
/// By how many times a stretch may be longer than the one before: the speed of another point may be another.
const GROWTH: u64 = 8;

/// The speed of one worker, as measured. It decides when the worker reports, and nothing of what it counts.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pace {
    /// Tosses of the next stretch.
    next: u64,
    reported: Instant,
}

impl Pace {
    pub(super) fn new(now: Instant) -> Self {
        Self {
            next: FIRST,
            reported: now,
        }
    }

    /// Takes note of a report, or of the beginning of a chunk.
    pub(super) fn reports(&mut self, now: Instant) {
        self.reported = now;
    }

    /// Whether it is time to report.
    pub(super) fn is_due(self, now: Instant) -> bool {
        now.saturating_duration_since(self.reported) >= REPORT
    }

    /// Tosses that take about a quarter of a second, of so many that are left. What would take hardly longer
    /// is not divided.
    pub(super) fn stretch(self, left: u64) -> u64 {
        if left <= self.next.saturating_mul(2) {
            left
        } else {
            self.next
        }
    }

    /// Takes note of how long a stretch took.
    pub(super) fn took(&mut self, tosses: u64, time: Duration) {
        let wanted = u128::from(tosses) * STRETCH.as_micros() / time.as_micros().max(1);
        let most = tosses.max(FIRST).saturating_mul(GROWTH);
        self.next = u64::try_from(wanted).map_or(most, |wanted| wanted.clamp(1, most));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretches_take_a_quarter_of_a_second_whatever_the_speed() {
        for tosses_a_second in [3_u64, 1_000, 2_000_000] {
            let mut pace = Pace::new(Instant::now());
            for stretch in 0..20 {
                let tosses = pace.stretch(1 << 40);
                let seconds = tosses as f64 / tosses_a_second as f64;
                // the first may be slow, as nothing is known of the speed
                assert!(
                    stretch == 0 || seconds < 0.34,
                    "{tosses_a_second}: {seconds} s"
                );
                assert!(
                    stretch < 8 || seconds > 0.2,
                    "{tosses_a_second}: {seconds} s"
                );
                pace.took(tosses, Duration::from_secs_f64(seconds));
            }
        }
    }

    /// A toss onto rough ground may take ten milliseconds.
    #[test]
    fn something_is_known_within_the_first_second() {
        let mut pace = Pace::new(Instant::now());
        assert!(pace.stretch(1 << 40) <= 100);
        // and soon it is as fast as it can be
        let mut tosses = 0;
        for _ in 0..6 {
            let stretch = pace.stretch(1 << 40);
            tosses += stretch;
            pace.took(stretch, Duration::from_secs_f64(stretch as f64 / 1e6));
        }
        assert!(tosses > 250_000, "{tosses}");
    }

    #[test]
    fn reports_are_due_twice_a_second() {
        let start = Instant::now();
        let (mut pace, at) = (Pace::new(start), |ms| start + Duration::from_millis(ms));
        assert!(!pace.is_due(at(499)) && pace.is_due(at(500)));
        pace.reports(at(700));
        assert!(!pace.is_due(at(1100)) && pace.is_due(at(1200)));
    }

    #[test]
    fn short_chunks_are_not_divided() {
        let mut pace = Pace::new(Instant::now());
        let most = 2 * FIRST;
        assert_eq!([1, most].map(|left| pace.stretch(left)), [1, most]);
        assert_eq!(pace.stretch(most + 1), FIRST);
        pace.took(1 << 17, Duration::from_millis(100));
        assert_eq!(pace.stretch(1 << 17), 1 << 17);
        // what is no time at all
        pace.took(100, Duration::ZERO);
        assert_eq!(pace.stretch(u64::MAX), 100 * GROWTH);
    }
}

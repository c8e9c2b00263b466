//! Work that stops in time.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

/// A time after which work is asked to stop.
#[derive(Debug, Default)]
pub(crate) struct TimeLimit {
    is_reached: Arc<AtomicBool>,
}

impl TimeLimit {
    /// Sets `cancel` after this time, unless it is set by then.
    pub(crate) fn start(limit: Duration, cancel: &'static AtomicBool) -> Self {
        let is_reached = Arc::new(AtomicBool::new(false));
        let to_set = Arc::clone(&is_reached);
        // ends with the process
        thread::spawn(move || {
            thread::sleep(limit);
            if !cancel.swap(true, Ordering::Relaxed) {
                to_set.store(true, Ordering::Relaxed);
            }
        });
        Self { is_reached }
    }

    /// Whether it was this that stopped the work.
    pub(crate) fn is_reached(&self) -> bool {
        self.is_reached.load(Ordering::Relaxed)
    }
}

/// A length of time: `1h`, `45min` or `45m`, `90s`, or `HH:MM:SS`.
pub(crate) fn duration(text: &str) -> Result<Duration, String> {
    let wrong = || "expected a time such as 1h, 45min, 90s or 01:30:00".to_owned();
    let number = |digits: &str| digits.parse::<u32>().map(u64::from).map_err(|_| wrong());
    let minutes = text.strip_suffix("min").or_else(|| text.strip_suffix('m'));
    let seconds = if let Some(hours) = text.strip_suffix('h') {
        3600 * number(hours)?
    } else if let Some(minutes) = minutes {
        60 * number(minutes)?
    } else if let Some(seconds) = text.strip_suffix('s') {
        number(seconds)?
    } else {
        let parts: Vec<&str> = text.split(':').collect();
        let [hours, minutes, seconds] = parts[..] else {
            return Err(wrong());
        };
        3600 * number(hours)? + 60 * number(minutes)? + number(seconds)?
    };
    if seconds == 0 {
        return Err(wrong());
    }
    Ok(Duration::from_secs(seconds))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_read_and_nonsense_is_refused() {
        for (text, seconds) in [
            ("1h", 3600),
            ("45min", 2700),
            ("55m", 3300),
            ("90s", 90),
            ("01:30:05", 5405),
        ] {
            assert_eq!(duration(text), Ok(Duration::from_secs(seconds)));
        }
        for bad in ["", "h", "1", "-1h", "0s", "1:30", "1h30", "99999999999h"] {
            assert!(duration(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn a_limit_knows_whether_it_was_the_one_that_stopped() {
        static STOPPED: AtomicBool = AtomicBool::new(true);
        static GOES_ON: AtomicBool = AtomicBool::new(false);
        let [late, early] =
            [&STOPPED, &GOES_ON].map(|flag| TimeLimit::start(Duration::from_millis(1), flag));
        while !GOES_ON.load(Ordering::Relaxed) {
            thread::yield_now();
        }
        thread::sleep(Duration::from_millis(20));
        assert!(early.is_reached() && !late.is_reached());
        assert!(!TimeLimit::default().is_reached());
    }
}

//! When a line is due where there is no bar: soon, so that a log shows at once what is wrong, and then seldom.

use std::sync::{Mutex, PoisonError};
use std::time::Duration;

/// Times after which lines are printed, from the beginning of the run; after the last, as often as that.
const DUE: [Duration; 3] = [
    Duration::from_secs(1),
    Duration::from_secs(10),
    Duration::from_mins(1),
];

/// What lines have been printed.
#[derive(Debug)]
pub(super) struct Lines {
    /// When the next is due; `None` if none ever is.
    next: Mutex<Option<Duration>>,
}

impl Lines {
    pub(super) fn new(never: bool) -> Self {
        Self {
            next: Mutex::new((!never).then_some(DUE[0])),
        }
    }

    /// Whether a line is due so long after the beginning; it is then taken as printed.
    pub(super) fn is_due(&self, time: Duration) -> bool {
        let mut next = self.next.lock().unwrap_or_else(PoisonError::into_inner);
        match *next {
            Some(due) if time >= due => {
                let later = DUE.into_iter().find(|later| *later > time);
                *next = Some(later.unwrap_or(time + DUE[DUE.len() - 1]));
                true
            }
            _ => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_come_after_a_second_then_ten_then_every_minute() {
        let lines = Lines::new(false);
        let tenths =
            (0..3000_u64).filter(|&tenths| lines.is_due(Duration::from_millis(100 * tenths)));
        assert_eq!(tenths.collect::<Vec<_>>(), [10, 100, 600, 1200, 1800, 2400]);
        let late = Lines::new(false);
        assert!(late.is_due(Duration::from_secs(75)) && !late.is_due(Duration::from_secs(100)));
        assert!(!Lines::new(true).is_due(Duration::from_secs(100)));
    }
}

//! Ctrl-C and SIGTERM: the first asks the run to stop, the second stops the process.
//!
//! `timeout`, shells and schedulers send a signal to the process and to its group, so that two arrive
//! at once. A signal that follows another within a second is the same one.

use crate::exit::INTERRUPTED;
use std::process;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Set by the first signal.
static CANCEL: AtomicBool = AtomicBool::new(false);
/// Set by the second signal, where it has something to do.
#[cfg(feature = "robot")]
static STOP: AtomicBool = AtomicBool::new(false);

/// A signal that follows the one before within this time is the same one.
const SAME_SIGNAL: Duration = Duration::from_secs(1);
/// The same where a second signal turns motors off: a person may press twice as fast as they can.
#[cfg(feature = "robot")]
const SAME_SIGNAL_AT_MOTORS: Duration = Duration::from_millis(50);

/// Counts signals.
#[derive(Debug)]
struct Signals {
    same: Duration,
    count: u32,
    last: Option<Instant>,
}

impl Signals {
    fn new(same: Duration) -> Self {
        Self {
            same,
            count: 0,
            last: None,
        }
    }

    /// The number of a signal at this time; `None` if it is the same as the one before.
    fn number(&mut self, now: Instant) -> Option<u32> {
        let is_same = |last| now.saturating_duration_since(last) < self.same;
        if self.last.is_some_and(is_same) {
            return None;
        }
        self.last = Some(now);
        self.count += 1;
        Some(self.count)
    }
}

/// Starts listening and returns the flag that a signal sets. `on_first` is called once, at the
/// first signal, on its own thread.
///
/// Nothing that was stored is lost when the second signal ends the process at once: a line of a tally file
/// is complete or ignored, and other files are renamed into place.
pub(crate) fn listen(
    mut on_first: impl FnMut() + Send + 'static,
) -> Result<&'static AtomicBool, ctrlc::Error> {
    let mut signals = Signals::new(SAME_SIGNAL);
    ctrlc::set_handler(move || match signals.number(Instant::now()) {
        None => {}
        Some(1) => {
            CANCEL.store(true, Ordering::Relaxed);
            on_first();
        }
        Some(_) => process::exit(i32::from(INTERRUPTED)),
    })?;
    Ok(&CANCEL)
}

/// Like [`listen`], but also the second signal only sets a flag; the third ends the process. Returns
/// the flags of the first and of the second signal.
#[cfg(feature = "robot")]
pub(crate) fn listen_twice(
    mut on_first: impl FnMut() + Send + 'static,
    mut on_second: impl FnMut() + Send + 'static,
) -> Result<(&'static AtomicBool, &'static AtomicBool), ctrlc::Error> {
    let mut signals = Signals::new(SAME_SIGNAL_AT_MOTORS);
    ctrlc::set_handler(move || match signals.number(Instant::now()) {
        None => {}
        Some(1) => {
            CANCEL.store(true, Ordering::Relaxed);
            on_first();
        }
        Some(2) => {
            STOP.store(true, Ordering::Relaxed);
            on_second();
        }
        Some(_) => process::exit(i32::from(INTERRUPTED)),
    })?;
    Ok((&CANCEL, &STOP))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_signal_within_a_second_of_another_is_the_same() {
        let (mut signals, start) = (Signals::new(SAME_SIGNAL), Instant::now());
        let mut at = |ms| signals.number(start + Duration::from_millis(ms));
        assert_eq!([at(0), at(1), at(999)], [Some(1), None, None]);
        assert_eq!([at(1000), at(1999), at(2000)], [Some(2), None, Some(3)]);
    }
}

//! Ctrl-C, SIGTERM and SIGHUP: the first asks the run to stop, the second stops the process.
//!
//! A hang-up that the process was started to ignore, as by `nohup`, stops nothing. (Where that is known: on Linux.)
//!
//! `timeout`, shells and schedulers send a signal to the process and to its group, so that two arrive
//! at once. A signal that follows another within a second is the same one.

use crate::exit::{Failure, INTERRUPTED};
use crate::output::Console;
use anyhow::Context;
use std::io;
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
) -> Result<&'static AtomicBool, Failure> {
    let mut signals = Signals::new(SAME_SIGNAL);
    on_signals(move || match signals.number(Instant::now()) {
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
) -> Result<(&'static AtomicBool, &'static AtomicBool), Failure> {
    let mut signals = Signals::new(SAME_SIGNAL_AT_MOTORS);
    on_signals(move || match signals.number(Instant::now()) {
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

/// Lets the first signal end the process at once, with what a failure prints: for work that nothing is lost of.
pub(crate) fn end_at_once(console: &Console) -> Result<(), Failure> {
    let console = *console;
    on_signals(move || process::exit(i32::from(Failure::Interrupted.report(&console))))
}

/// Calls `handle` at each signal, on a thread of its own.
fn on_signals(handle: impl FnMut() + Send + 'static) -> Result<(), Failure> {
    set_handler(handle)
        .context("cannot listen for signals")
        .map_err(Failure::Runtime)
}

#[cfg(unix)]
fn set_handler(mut handle: impl FnMut() + Send + 'static) -> io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    let hang_up = (!ignores_hang_up()).then_some(SIGHUP);
    let signals = [SIGINT, SIGTERM].into_iter().chain(hang_up);
    let mut signals = signal_hook::iterator::Signals::new(signals)?;
    let listen = move || signals.forever().for_each(|_| handle());
    std::thread::Builder::new()
        .name("signals".to_owned())
        .spawn(listen)?;
    Ok(())
}

#[cfg(not(unix))]
fn set_handler(handle: impl FnMut() + Send + 'static) -> io::Result<()> {
    ctrlc::set_handler(handle).map_err(io::Error::other)
}

/// Whether whoever started the process lets it ignore hang-ups.
#[cfg(unix)]
fn ignores_hang_up() -> bool {
    let status = std::fs::read_to_string("/proc/self/status");
    status.is_ok_and(|status| is_ignored(&status, signal_hook::consts::SIGHUP))
}

/// Whether a process with this status (`man 5 proc`) ignores a signal.
#[cfg(unix)]
fn is_ignored(status: &str, signal: i32) -> bool {
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn an_ignored_signal_has_its_bit() {
        let status = |mask: &str| format!("Name:\tcoinmc\nSigBlk:\t{0}\nSigIgn:\t{mask}\n", "1");
        for (mask, signal, ignored) in [
            ("0000000000000001", 1, true),
            ("0000000000000002", 1, false),
            ("0000000000004002", 15, true),
            ("zz", 1, false),
        ] {
            assert_eq!(
                is_ignored(&status(mask), signal),
                ignored,
                "{mask} {signal}"
            );
        }
        assert!(!is_ignored("", 1));
    }

    #[test]
    fn a_signal_within_a_second_of_another_is_the_same() {
        let (mut signals, start) = (Signals::new(SAME_SIGNAL), Instant::now());
        let mut at = |ms| signals.number(start + Duration::from_millis(ms));
        assert_eq!([at(0), at(1), at(999)], [Some(1), None, None]);
        assert_eq!([at(1000), at(1999), at(2000)], [Some(2), None, Some(3)]);
    }
}

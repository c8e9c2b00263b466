//! Ctrl-C and SIGTERM: the first asks the run to stop, the second stops the process.

use crate::exit::INTERRUPTED;
use std::process;
use std::sync::atomic::{AtomicBool, Ordering};

/// Set by the first signal.
static CANCEL: AtomicBool = AtomicBool::new(false);
/// Set by the second signal, where it has something to do.
#[cfg(feature = "robot")]
static STOP: AtomicBool = AtomicBool::new(false);

/// Starts listening and returns the flag that a signal sets. `on_first` is called once, at the
/// first signal, on its own thread.
///
/// Nothing is lost when the second signal ends the process at once: chunks are renamed into place,
/// so each file is complete or absent.
pub(crate) fn listen(
    mut on_first: impl FnMut() + Send + 'static,
) -> Result<&'static AtomicBool, ctrlc::Error> {
    ctrlc::set_handler(move || {
        if CANCEL.swap(true, Ordering::Relaxed) {
            process::exit(i32::from(INTERRUPTED));
        }
        on_first();
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
    ctrlc::set_handler(move || {
        if !CANCEL.swap(true, Ordering::Relaxed) {
            on_first();
        } else if !STOP.swap(true, Ordering::Relaxed) {
            on_second();
        } else {
            process::exit(i32::from(INTERRUPTED));
        }
    })?;
    Ok((&CANCEL, &STOP))
}

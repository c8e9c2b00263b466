//! The watchdog, and what happens when the program fails: motors off, then a reset.

use crate::pins;
use crate::register::{get, set};
use cortex_m_rt::{ExceptionFrame, exception};

const CLOCK_GATES: usize = 0x400F_E100;
const LOAD: usize = 0x4000_0000;
const CONTROL: usize = 0x4000_0008;
const CLEAR: usize = 0x4000_000C;
const LOCK: usize = 0x4000_0C00;
const UNLOCK: u32 = 0x1ACC_E551;
/// Brown-out: reset the chip, not just interrupt it.
const BROWN_OUT: usize = 0x400F_E030;

/// The running watchdog: the chip is reset if it is not fed for a second.
pub struct Watchdog(());

impl Watchdog {
    /// Starts it. Its first end is an interrupt that nobody takes, its second one the reset.
    pub fn begin() -> Self {
        set(BROWN_OUT, 1 << 1);
        set(CLOCK_GATES, get(CLOCK_GATES) | 1 << 3);
        set(LOCK, UNLOCK);
        set(LOAD, crate::clock::HERTZ / 2);
        set(CONTROL, 1 << 1);
        set(CONTROL, 1 << 1 | 1);
        set(LOCK, 0);
        Self(())
    }

    /// Begins its second anew.
    #[allow(clippy::unused_self)] // having a watchdog proves that it was started
    pub fn feed(&self) {
        set(LOCK, UNLOCK);
        // any value: ends the interrupt and loads the counter
        set(CLEAR, 1);
        set(LOCK, 0);
    }
}

/// Puts the watchdog off by minutes, for tests of what happens without it.
#[cfg(feature = "simulator")]
pub fn put_off() {
    set(LOCK, UNLOCK);
    set(LOAD, u32::MAX);
    set(LOCK, 0);
}

/// Bad access, bad instruction, anything that nothing else handles.
// SAFETY: it only writes to a pin.
#[exception]
unsafe fn HardFault(_: &ExceptionFrame) -> ! {
    stop_for_ever()
}

/// An interrupt that nobody handles: a fault of the program, too.
// SAFETY: as above.
#[exception]
unsafe fn DefaultHandler(_: i16) {
    stop_for_ever()
}

/// Motors off, until the watchdog resets the chip.
fn stop_for_ever() -> ! {
    loop {
        pins::enable_motors(false);
    }
}

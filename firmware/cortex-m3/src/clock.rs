//! Milliseconds since the start, counted by the SysTick timer.

use core::sync::atomic::{AtomicU32, Ordering};
use cortex_m::peripheral::{SYST, syst::SystClkSource};
use cortex_m_rt::exception;

/// The LM3S6965 starts on its 12 MHz oscillator.
pub const HERTZ: u32 = 12_000_000;

static ELAPSED_MS: AtomicU32 = AtomicU32::new(0);

/// The running clock.
#[derive(Clone, Copy)]
pub struct Clock(());

impl Clock {
    /// Starts the timer.
    pub fn begin(mut timer: SYST) -> Self {
        timer.set_clock_source(SystClkSource::Core);
        timer.set_reload(HERTZ / 1000 - 1);
        timer.clear_current();
        timer.enable_counter();
        timer.enable_interrupt();
        Self(())
    }

    /// Milliseconds since the start; wraps.
    #[allow(clippy::unused_self)] // having a clock proves that it was started
    pub fn now_ms(self) -> u32 {
        ELAPSED_MS.load(Ordering::Relaxed)
    }
}

#[exception]
fn SysTick() {
    // the only writer (no read-modify-write exists on smaller cores)
    let now = ELAPSED_MS.load(Ordering::Relaxed);
    ELAPSED_MS.store(now.wrapping_add(1), Ordering::Relaxed);
}

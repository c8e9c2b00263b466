//! Pins for motors and emergency stop.
//!
//! PD0 enables all motor drivers (high). A pull-down of 10 kOhm keeps them off while the chip is in
//! reset, has crashed or is being flashed. PF1 is the evaluation board's button (low when pressed):
//! on a real robot, connect a normally closed contact to ground and turn `is_stopped` around, so that
//! a cut wire stops like a pressed button. The contact must also cut the motors' supply by itself.

use crate::register::{get, set};

const CLOCK_GATES: usize = 0x400F_E108;
const PORT_D: usize = 0x4000_7000;
const PORT_E: usize = 0x4002_4000;
const PORT_F: usize = 0x4002_5000;
const DIRECTION: usize = 0x400;
const PULL_UP: usize = 0x510;
const DIGITAL: usize = 0x51C;
/// The data register seen through a mask in its address: only pin 0, or only pin 1.
const PIN_0: usize = 1 << 2;
const PIN_1: usize = 2 << 2;
#[cfg(feature = "simulator")]
const PIN_2: usize = 4 << 2;

/// Motors off; the input ready.
pub fn begin() {
    set(CLOCK_GATES, get(CLOCK_GATES) | 1 << 3 | 1 << 4 | 1 << 5);
    enable_motors(false);
    set(PORT_D + DIRECTION, get(PORT_D + DIRECTION) | 1);
    set(PORT_D + DIGITAL, get(PORT_D + DIGITAL) | 1);
    for (port, pin) in [(PORT_E, 1), (PORT_F, 2)] {
        set(port + PULL_UP, get(port + PULL_UP) | pin);
        set(port + DIGITAL, get(port + DIGITAL) | pin);
    }
}

/// Switches the current of all motors.
pub fn enable_motors(on: bool) {
    set(PORT_D + PIN_0, u32::from(on));
}

/// Whether the emergency stop is pressed.
pub fn is_stopped() -> bool {
    is_low(PORT_F + PIN_1, 2)
}

/// Whether motions are stuck, for tests: the evaluation board's button `up` is pressed.
pub fn is_stuck() -> bool {
    is_low(PORT_E + PIN_0, 1)
}

/// Fails on demand, for tests: hangs while the button `down` is pressed, executes what is no instruction
/// when `left` is, without the watchdog.
#[cfg(feature = "simulator")]
pub fn fail_on_demand() {
    while is_low(PORT_E + PIN_1, 4) {}
    if is_low(PORT_E + PIN_2, 8) {
        crate::watchdog::put_off();
        cortex_m::asm::udf();
    }
}

#[cfg(not(feature = "simulator"))]
fn is_low(input: usize, _: u32) -> bool {
    get(input) == 0
}

/// QEMU has no pull-ups: a button reads low until it was used once.
#[cfg(feature = "simulator")]
fn is_low(input: usize, button: u32) -> bool {
    use core::sync::atomic::{AtomicU32, Ordering};
    static USED: AtomicU32 = AtomicU32::new(0);
    let used = USED.load(Ordering::Relaxed);
    if get(input) != 0 {
        USED.store(used | button, Ordering::Relaxed);
        return false;
    }
    used & button != 0
}

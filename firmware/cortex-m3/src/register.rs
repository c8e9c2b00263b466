//! Registers of the chip.

use core::ptr::{read_volatile, write_volatile};

/// Reads a register.
pub fn get(address: usize) -> u32 {
    // SAFETY: callers name registers and flash of this chip, which are always there; each file uses
    // only its own.
    unsafe { read_volatile(address as *const u32) }
}

/// Writes a register.
pub fn set(address: usize, value: u32) {
    // SAFETY: as above.
    unsafe { write_volatile(address as *mut u32, value) }
}

//! The serial line: UART 0 (an ARM PL011), 115200 baud, 8 bits, no parity, one stop bit.

use crate::register::{get, set};

const UART0: usize = 0x4000_C000;
const DATA: usize = UART0;
const FLAGS: usize = UART0 + 0x18;
const BAUD_INTEGER: usize = UART0 + 0x24;
const BAUD_FRACTION: usize = UART0 + 0x28;
const LINE: usize = UART0 + 0x2C;
const CONTROL: usize = UART0 + 0x30;
const CLOCK_GATES_1: usize = 0x400F_E104;
const CLOCK_GATES_2: usize = 0x400F_E108;
const PORT_A_FUNCTION: usize = 0x4000_4420;
const PORT_A_DIGITAL: usize = 0x4000_451C;

const RECEIVE_EMPTY: u32 = 1 << 4;
const TRANSMIT_FULL: u32 = 1 << 5;
/// Readings of a register in about a millisecond.
const PATIENCE: u32 = 2_000;

/// The running UART. Its queue of 16 bytes takes 1.4 ms to fill, and the main loop runs every
/// millisecond: no interrupt is needed.
pub struct Uart(());

impl Uart {
    /// Sets pins, speed and queue.
    pub fn begin() -> Self {
        set(CLOCK_GATES_1, get(CLOCK_GATES_1) | 1);
        set(CLOCK_GATES_2, get(CLOCK_GATES_2) | 1);
        set(PORT_A_FUNCTION, get(PORT_A_FUNCTION) | 3);
        set(PORT_A_DIGITAL, get(PORT_A_DIGITAL) | 3);
        set(CONTROL, 0);
        // 12 MHz / 16 / 115200 = 6 + 33/64
        set(BAUD_INTEGER, 6);
        set(BAUD_FRACTION, 33);
        set(LINE, 0x70);
        set(CONTROL, 0x301);
        Self(())
    }

    /// The next byte received.
    #[allow(clippy::unused_self)] // having a UART proves that it was started
    pub fn read(&self) -> Option<u8> {
        (get(FLAGS) & RECEIVE_EMPTY == 0).then(|| get(DATA).to_le_bytes()[0])
    }

    /// Sends the bytes; returns when the last byte is in the queue.
    #[allow(clippy::unused_self)]
    pub fn write(&self, bytes: &[u8]) {
        for byte in bytes {
            // a byte takes 90 µs: if the line is dead for ten times that, the reply is lost
            if (0..PATIENCE).all(|_| get(FLAGS) & TRANSMIT_FULL != 0) {
                return;
            }
            set(DATA, u32::from(*byte));
        }
    }
}

//! Firmware of the coin-tossing robot: `coinmc-link`'s device with this board's hardware.
//!
//! It cannot panic: the handler below does not link, so a build succeeds only if the optimiser has
//! proved every panic in the program unreachable.
#![no_std]
#![no_main]

mod clock;
mod hardware;
mod journal;
mod pins;
mod register;
mod uart;
mod watchdog;

use clock::Clock;
use coinmc_link::Device;
use hardware::Robot;
use uart::Uart;
use watchdog::Watchdog;

/// Bytes handled between two checks of the limits, 2.8 ms of them: however many arrive.
const BYTES_A_TICK: u32 = 32;

#[cortex_m_rt::entry]
fn main() -> ! {
    pins::begin();
    let Some(core) = cortex_m::Peripherals::take() else {
        // they are taken only here: this never fails
        loop {
            cortex_m::asm::wfi();
        }
    };
    let clock = Clock::begin(core.SYST);
    let watchdog = Watchdog::begin();
    let uart = Uart::begin();
    let mut device = Device::boot(Robot::new(clock), clock.now_ms());
    loop {
        for _ in 0..BYTES_A_TICK {
            let Some(byte) = uart.read() else { break };
            if let Some(reply) = device.receive(byte, clock.now_ms()) {
                uart.write(reply);
            }
        }
        device.tick(clock.now_ms());
        watchdog.feed();
        #[cfg(feature = "simulator")]
        pins::fail_on_demand();
        // until the next byte or millisecond
        cortex_m::asm::wfi();
    }
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    unsafe extern "C" {
        /// Not defined anywhere: a linker error about it means that a panic was added.
        fn the_firmware_must_not_panic() -> !;
    }
    // SAFETY: never linked, hence never called.
    unsafe { the_firmware_must_not_panic() }
}

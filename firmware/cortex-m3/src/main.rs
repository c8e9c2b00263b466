//! Firmware of the coin-tossing robot: `coinmc-link`'s device with this board's hardware.
//!
//! It cannot panic: the handler below does not link, so a build succeeds only if the optimiser has
//! proved every panic in the program unreachable.
#![no_std]
#![no_main]

mod clock;
mod hardware;
mod journal;
mod uart;

use clock::Clock;
use coinmc_link::Device;
use hardware::Robot;
use uart::Uart;

#[cortex_m_rt::entry]
fn main() -> ! {
    let Some(core) = cortex_m::Peripherals::take() else {
        // they are taken only here: this never fails
        loop {
            cortex_m::asm::wfi();
        }
    };
    let clock = Clock::begin(core.SYST);
    let uart = Uart::begin();
    let mut device = Device::boot(Robot::new(clock), clock.now_ms());
    loop {
        while let Some(byte) = uart.read() {
            if let Some(reply) = device.receive(byte, clock.now_ms()) {
                uart.write(reply);
            }
        }
        device.tick(clock.now_ms());
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

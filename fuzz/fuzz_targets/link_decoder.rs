//! Any bytes on the robot's link. Run with `cargo +nightly fuzz run link_decoder`.
#![no_main]

#[path = "../properties/link.rs"]
#[allow(dead_code)] // the device's are another target's
mod properties;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| properties::decoder(bytes));

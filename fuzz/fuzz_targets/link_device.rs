//! Any course of events at the robot. Run with `cargo +nightly fuzz run link_device`.
#![no_main]

#[path = "../properties/link.rs"]
#[allow(dead_code)] // the decoder's are another target's
mod properties;

libfuzzer_sys::fuzz_target!(|script: &[u8]| properties::device(script));

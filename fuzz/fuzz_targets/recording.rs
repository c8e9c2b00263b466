//! Any bytes are either an error or a recording that can be heard to its end, in which all numbers are finite. Run
//! with `cargo +nightly fuzz run recording`.
#![no_main]

use coinmc_listen::{Heard, Recording};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let Ok(recording) = Recording::from_bytes("fuzz.wav", bytes) else {
        return;
    };
    assert!(recording.samples.iter().all(|sample| sample.is_finite()));
    let heard = Heard::of(&recording, None, None);
    assert!(heard.kind.is_some() || heard.silence().is_some());
    for onset in &heard.onsets.onsets {
        assert!(onset.time_s.is_finite() && onset.strength.is_finite());
    }
});

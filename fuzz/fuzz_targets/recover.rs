//! Whatever bytes are salvaged, the result is a whole recording of as many messages.
//!
//! Run with `cargo +nightly fuzz run recover`.
#![no_main]

use coinmc_recording::{Passing, salvage};
use libfuzzer_sys::fuzz_target;
use std::io::Cursor;

fuzz_target!(|bytes: &[u8]| {
    let mut anew = Vec::new();
    let Ok(recovered) = salvage(Cursor::new(bytes), Passing(&mut anew)) else {
        // no recording at all; memory takes everything else
        return;
    };
    let again = salvage(Cursor::new(&anew), Passing(Vec::new())).expect("it was just written");
    assert!(again.was_whole());
    assert_eq!(
        (again.messages, again.channels, again.attachments, again.metadata),
        (recovered.messages, recovered.channels, recovered.attachments, recovered.metadata)
    );
});

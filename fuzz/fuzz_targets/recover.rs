//! Salvaging any bytes gives an undamaged recording with the reported number of messages.
//!
//! Run with `cargo +nightly fuzz run recover`.
#![no_main]

use coinmc_recording::{Unsynced, salvage};
use libfuzzer_sys::fuzz_target;
use std::io::Cursor;

fuzz_target!(|bytes: &[u8]| {
    let mut rewritten = Vec::new();
    let Ok(recovered) = salvage(Cursor::new(bytes), Unsynced(&mut rewritten)) else {
        // not a recording; no other error can occur in memory
        return;
    };
    let again = salvage(Cursor::new(&rewritten), Unsynced(Vec::new())).expect("it was just written");
    assert!(again.was_whole());
    assert_eq!(
        (again.messages, again.channels, again.attachments, again.metadata),
        (recovered.messages, recovered.channels, recovered.attachments, recovered.metadata)
    );
});

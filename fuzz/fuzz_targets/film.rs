//! Any bytes are either a drop, which reads the same after it was written, or problems that can be
//! shown. Run with `cargo +nightly fuzz run film`.
#![no_main]

use coinmc_film::text::{AngleOf, Choice, Dialect, read, write};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    match read("fuzz.txt", bytes, &Choice::default()) {
        Ok(footage) => {
            let written = write(
                &footage.drop,
                "coin",
                AngleOf::Face,
                &Dialect::default(),
                None,
            );
            let again = read("again.txt", &written, &Choice::default()).expect("what was written");
            for (a, b) in footage.drop.frames.iter().zip(&again.drop.frames) {
                assert_eq!(
                    (a.time_s, a.seen[0], a.seen[1]),
                    (b.time_s, b.seen[0], b.seen[1])
                );
            }
        }
        Err(diagnostics) => {
            assert!(!diagnostics.problems().is_empty());
            assert!(!diagnostics.render(false).is_empty());
        }
    }
});

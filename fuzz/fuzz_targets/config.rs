//! Any text is either a plan, whose resolved text is the same plan but for the notes on what it spells out, or
//! problems that can be shown.
//!
//! The first line is an override if it begins with `--set `. Run with
//! `cargo +nightly fuzz run config`.
#![no_main]

use coinmc::config::{self, Override};
use coinmc::plan::Plan;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let (first, rest) = text.split_once('\n').unwrap_or((text, ""));
    let set = first.strip_prefix("--set ").and_then(|set| set.parse::<Override>().ok());
    let text = if set.is_some() { rest } else { text };
    match config::parse("fuzz.toml", text, set.as_slice()) {
        Ok(plan) => {
            let again = config::parse("again.toml", &plan.resolved_toml, &[]);
            let again = again.map(|again| Plan { notes: plan.notes.clone(), ..again });
            assert!(again.is_ok_and(|again| again == plan));
        }
        Err(diagnostics) => {
            assert!(!diagnostics.problems().is_empty());
            assert!(!diagnostics.render(false).is_empty());
        }
    }
});

//! The ATmega328P's journal, compiled for this machine, on an EEPROM of 3.4 ms a byte that a reset
//! interrupts at every byte.

mod support;

use coinmc_link::REPLY_TIMEOUT_MS;
use std::process::Command;

#[test]
fn a_reset_between_any_two_bytes_costs_at_most_the_record_being_written() {
    let sources = ["tests/c/eeprom.c", "../../firmware/atmega328p/journal.c"];
    // without the padding that the chip does not have
    let options = ["-Itests/c/chip", "-fpack-struct"];
    let Some(program) = support::compile_with("eeprom", &sources, &options) else {
        return;
    };
    let output = Command::new(&program.path).output().expect("it starts");
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{text}");
    let numbers: Vec<u64> = text
        .split_whitespace()
        .map(|word| word.parse().expect("a number"))
        .collect();
    let [resets, longest_us] = numbers[..] else {
        panic!("{text}");
    };
    assert!(resets > 10_000, "{resets}");
    // the host waits that long for an answer
    assert!(longest_us < 1000 * REPLY_TIMEOUT_MS, "{longest_us} µs");
    println!("{resets} resets within a record; the longest took {longest_us} µs");
}

//! The command `coinmc`: how likely does a tossed cylinder come to rest on heads, on tails or on
//! its side?
//!
//! A library, so that the Python wheel has the command too, in the code that it holds anyway. Its
//! only function is [`main`]; programs use the crates below this one.

// An allocation per line of text costs nothing here, and `write!` would add a result to ignore.
#![allow(clippy::format_push_string)]

mod arguments;
mod command_line;
mod commands;
mod exit;
mod interrupt;
mod negative;
mod output;
mod terminal;
mod time_limit;

use std::ffi::OsString;

/// Does what a command line says, the first word of which is the name of the program, and returns
/// the exit status.
///
/// It listens to signals, and the second Ctrl-C ends the process: for processes that do nothing else.
///
/// # Example
/// ```
/// assert_eq!(coinmc_cli::main(["coinmc", "analytic", "--fair"].map(Into::into)), 0);
/// assert_eq!(coinmc_cli::main(["coinmc", "rum"].map(Into::into)), 2);
/// ```
pub fn main(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    let words: Vec<OsString> = arguments.into_iter().collect();
    command_line::remember(&words);
    match arguments::Arguments::read(&words) {
        Ok(arguments) => arguments.execute(),
        Err(error) => {
            // if standard error is closed, the exit status still reports the failure
            let _ = error.print();
            // 0 or 2
            error.exit_code().try_into().unwrap_or(exit::BAD_INPUT)
        }
    }
}

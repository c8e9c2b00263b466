//! The command `coinmc`: how likely does a tossed cylinder come to rest on heads, on tails or on
//! its side?

// An allocation per line of text costs nothing here, and `write!` would add a result to ignore.
#![allow(clippy::format_push_string)]

mod arguments;
mod commands;
mod exit;
mod interrupt;
mod output;
mod terminal;

use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    arguments::Arguments::parse().execute()
}

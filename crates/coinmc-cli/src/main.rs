//! The program `coinmc`.

use std::env;
use std::process::ExitCode;

fn main() -> ExitCode {
    coinmc_cli::main(env::args_os()).into()
}

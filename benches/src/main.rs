//! `coinmc-bench`: studies of accuracy, speed and robustness, one a subcommand.

mod arguments;
mod legs;
mod number;
mod processor_time;
mod report;
mod run_apart;
mod run_once;
mod studies;
mod worst;

use clap::Parser;

fn main() -> anyhow::Result<()> {
    arguments::Arguments::parse().execute()
}

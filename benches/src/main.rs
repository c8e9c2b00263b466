//! `coinmc-bench`: speed and memory, one study per subcommand.

mod arguments;
mod lanes;
mod rapier_speed;
mod run_apart;
mod scaling;
mod speed;

use clap::Parser;

fn main() -> anyhow::Result<()> {
    arguments::Arguments::parse().execute()
}

//! `coinmc-studies`: validation of the engines and of the runner, one study per subcommand.

mod arguments;
mod atlas;
mod balance;
mod calibrate;
mod conical;
mod convergence;
mod energy;
mod film;
mod flat_table;
mod flight;
mod grid;
mod impacts;
mod integration;
mod legs;
mod link_fuzz;
mod listen;
mod missed_contacts;
mod oracle;
mod paired;
mod phases;
mod rapier;
mod robot_soak;
mod rough;
mod same_side;
mod sample;
mod space;
mod stability;
mod stopping_rule;
mod survey;
mod undecided;
mod worst;

use clap::Parser;

fn main() -> anyhow::Result<()> {
    arguments::Arguments::parse().execute()
}

//! `coinmc-studies`: validation of the engines and of the runner, one study per subcommand.

mod arguments;
mod convergence;
mod energy;
mod film;
mod flat_table;
mod impacts;
mod integration;
mod legs;
mod link_fuzz;
mod missed_contacts;
mod oracle;
mod rapier;
mod robot_soak;
mod sensitivity;
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

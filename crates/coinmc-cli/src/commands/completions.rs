//! `coinmc completions`: scripts that let a shell complete arguments.

use crate::exit::{Failure, Outcome};
use crate::output;
use clap::Args;
use clap_complete::Shell;

const EXAMPLES: &str = "\
Examples:
  coinmc completions bash > ~/.local/share/bash-completion/completions/coinmc
  coinmc completions fish > ~/.config/fish/completions/coinmc.fish";

/// Print a completion script for a shell
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Completions {
    /// The shell
    shell: Shell,
}

impl Completions {
    /// Prints the script that completes the arguments of `program`.
    pub(crate) fn execute(&self, mut program: clap::Command) -> Result<Outcome, Failure> {
        // Into memory first: the generator panics where a pipe breaks.
        let mut script = Vec::new();
        clap_complete::generate(self.shell, &mut program, "coinmc", &mut script);
        let script = String::from_utf8_lossy(&script);
        output::print(&script).map_err(|error| Failure::Runtime(error.into()))?;
        Ok(Outcome::Done)
    }
}

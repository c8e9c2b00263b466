//! The command line.

use crate::lanes::LaneRates;
use crate::rapier_speed::RapierSpeed;
use crate::run_apart::RunApart;
use crate::scaling::Scaling;
use crate::speed::Speed;
use anyhow::anyhow;
use clap::{Args, Parser, Subcommand};
use coinmc_bench::{Output, Workload, number, rough_workloads, space_workloads, workloads};
use std::hint::black_box;
use std::io::{self, Write};

/// Speed and memory of the engines and of the runner.
///
/// Tables go to standard output. Trust ratios, not rates, unless the machine is idle.
#[derive(Debug, Parser)]
#[command(name = "coinmc-bench", version, max_term_width = 100)]
pub(crate) struct Arguments {
    #[command(flatten)]
    output: Output,

    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Tosses per second per core, cost of the runner, two threads, peak memory
    Speed(Speed),
    /// Tosses in batches against the scalar path, with every kind of lanes
    Lanes(LaneRates),
    /// Whole runs over threads and numbers of tosses: rate, speed-up, memory
    Scaling(Scaling),
    /// On Rapier: tosses per second with all skips, against the naive loop
    RapierSpeed(RapierSpeed),
    /// Do one named piece of work, for a profiler
    Work(Work),
    /// Execute one run and print its cost: seconds, processor seconds, peak kB
    #[command(hide = true)]
    RunApart(RunApart),
}

impl Arguments {
    /// Executes the command.
    pub(crate) fn execute(self) -> anyhow::Result<()> {
        let output = self.output;
        match self.command {
            Command::Speed(study) => output.report(|seed| study.execute(seed)),
            Command::Lanes(study) => output.report(|_| Ok(study.execute())),
            Command::Scaling(study) => output.report(|_| study.execute()),
            Command::RapierSpeed(study) => output.report(|seed| study.execute(seed)),
            Command::Work(work) => work.execute(),
            Command::RunApart(run) => run.execute(),
        }
    }
}

/// One named piece of work.
#[derive(Debug, Args)]
struct Work {
    /// Its name; without one, all names are printed
    name: Option<String>,

    /// How often to do it
    #[arg(long, value_parser = number::count_or_zero, default_value = "10000", value_name = "N")]
    count: u64,
}

impl Work {
    fn execute(&self) -> anyhow::Result<()> {
        let all = [workloads(), space_workloads(), rough_workloads()].concat();
        let Some(name) = &self.name else {
            let names: Vec<&str> = all.iter().map(|work| work.name.as_str()).collect();
            writeln!(io::stdout(), "{}", names.join("\n"))?;
            return Ok(());
        };
        let work = all.iter().find(|work: &&Workload| work.name == *name);
        let work = work.ok_or_else(|| {
            anyhow!("no piece of work is called `{name}`; `coinmc-bench work` lists them")
        })?;
        black_box(work.run(0..self.count));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_arguments_are_consistent() {
        Arguments::command().debug_assert();
    }
}

//! What can be asked for on the command line.

use crate::number;
use crate::run_apart::RunApart;
use crate::studies::{
    Convergence, Energy, Film, FlatLanes, FlatTable, ImpactAccuracy, ImpactBalance, ImpactCurves,
    ImpactLimit, Integration, LinkFuzz, MissedContacts, Oracle, RapierEnergy, RapierRestitution,
    RapierSpeed, RapierStep, RapierStress, RobotSoak, Scaling, Sensitivity, SpaceConvergence,
    SpaceDecision, SpaceEnergy, SpaceLanes, SpaceLaws, SpaceMissed, SpacePeers, SpaceReferences,
    SpaceSpeed, SpaceStress, Speed, Stability, StoppingRule, Undecided,
};
use anyhow::{Context, anyhow};
use clap::{Args, Parser, Subcommand};
use coinmc_bench::{Workload, space_workloads, workloads};
use std::fs::File;
use std::hint::black_box;
use std::io::{self, Write};
use std::path::PathBuf;

/// Studies of the engines and of the runner: accuracy, speed, robustness.
///
/// Tables go to standard output. All of it is deterministic except what is measured by a clock:
/// the same seed gives the same numbers on any machine, with any number of threads. The variable
/// RAYON_NUM_THREADS sets how many threads a study uses (all cores without it).
#[derive(Debug, Parser)]
#[command(name = "coinmc-bench", version, max_term_width = 100)]
pub(crate) struct Arguments {
    /// Also write every row of the study to this file
    #[arg(long, global = true, value_name = "FILE")]
    csv: Option<PathBuf>,

    /// Key of all random numbers
    #[arg(long, global = true, default_value_t = 1)]
    seed: u64,

    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// P(side) in the scenes of an earlier planar study, and against Chipmunk and Box2D
    FlatTable(FlatTable),
    /// Flat tosses side by side against one after the other
    FlatLanes(FlatLanes),
    /// Fits to synthetic film: how often the intervals hold the truth
    Film(Film),
    /// How P(side) depends on the engine's settings, toss by toss
    Convergence(Convergence),
    /// Every flight against dense sampling: contacts passed over, energy gained
    MissedContacts(MissedContacts),
    /// The volumetric engine against fixed-step time stepping, toss by toss
    Oracle(Oracle),
    /// Worst gain of energy in impacts and in contact phases
    Energy(Energy),
    /// Tosses without a face at the limit of impacts, and the slowest scenes
    Undecided(Undecided),
    /// How often stopping at a hundredth of the energy names another face
    StoppingRule(StoppingRule),
    /// How the fair ratio depends on drop height, restitution and friction
    Sensitivity(Sensitivity),
    /// Adhesive scenes: error of random and Sobol tosses, control variate, quadrature
    Integration(Integration),
    /// Either engine under random tosses from a huge box: errors, gains and limits by region
    Stability(Stability),
    /// Whole runs over threads and numbers of tosses: rate, speed-up, memory
    Scaling(Scaling),
    /// Tosses a second, cost of the runner, two threads, peak memory
    Speed(Speed),
    /// Laws of impact: P(side) and the fair ratio under each
    ImpactCurves(ImpactCurves),
    /// Laws of impact: what line contact and half sine become in the stiff limit
    ImpactLimit(ImpactLimit),
    /// Laws of impact: error against run time
    ImpactAccuracy(ImpactAccuracy),
    /// Laws of impact: stress of the line contact, and its balance of energy
    ImpactBalance(ImpactBalance),
    /// In space: how P(side) depends on the engine's settings, toss by toss
    SpaceConvergence(SpaceConvergence),
    /// In space: P(side) with its total error, by law of impact
    SpaceLaws(SpaceLaws),
    /// In space: the reference values of an earlier study, under its law of impact and ours
    SpaceReferences(SpaceReferences),
    /// In space: every flight against dense sampling
    SpaceMissed(SpaceMissed),
    /// In space: gains of energy, and the balance of contact phases
    SpaceEnergy(SpaceEnergy),
    /// In space: random tosses from a huge box of scenes
    SpaceStress(SpaceStress),
    /// In space: tosses a second, and the numerical bias at that speed
    SpaceSpeed(SpaceSpeed),
    /// In space: tosses side by side against one after the other
    SpaceLanes(SpaceLanes),
    /// In space: P(side) beside what other engines give
    SpacePeers(SpacePeers),
    /// In space: the decision by tilting energy against the rigorous one
    SpaceDecision(SpaceDecision),
    /// Any bytes on the robot's link: does either end ever break a rule or panic
    LinkFuzz(LinkFuzz),
    /// On Rapier: P(side) against the step, beside the event-driven engine
    RapierStep(RapierStep),
    /// On Rapier: tosses a second with all skips, against the naive loop
    RapierSpeed(RapierSpeed),
    /// On Rapier: how far the energy rises above its value at launch
    RapierEnergy(RapierEnergy),
    /// On Rapier: random tosses from a huge box of scenes
    RapierStress(RapierStress),
    /// On Rapier: landings and rolling that are known exactly, against the step
    RapierRestitution(RapierRestitution),
    /// A simulated robot through noise, resets, unpluggings and kills: nothing lost or doubled
    RobotSoak(RobotSoak),
    /// Do one named piece of work, for a profiler
    Work(Work),
    /// Do one run and print what it took: seconds, processor seconds, peak kB
    #[command(hide = true)]
    RunApart(RunApart),
}

impl Arguments {
    /// Does what was asked.
    pub(crate) fn execute(self) -> anyhow::Result<()> {
        // before the study: a typing error should not cost minutes
        let csv = self
            .csv
            .map(|path| match File::create(&path) {
                Ok(file) => Ok((path, file)),
                Err(error) => Err(anyhow!("cannot write {}: {error}", path.display())),
            })
            .transpose()?;
        let seed = self.seed;
        let report = match self.command {
            Command::FlatTable(study) => study.execute(seed),
            Command::FlatLanes(study) => study.execute(),
            Command::Film(study) => study.execute(seed),
            Command::Convergence(study) => study.execute(seed),
            Command::MissedContacts(study) => study.execute(seed),
            Command::Oracle(study) => study.execute(seed),
            Command::Energy(study) => study.execute(seed),
            Command::Undecided(study) => study.execute(seed),
            Command::StoppingRule(study) => study.execute(seed),
            Command::Sensitivity(study) => study.execute(seed)?,
            Command::Integration(study) => study.execute(seed),
            Command::Stability(study) => study.execute(seed)?,
            Command::Scaling(study) => study.execute()?,
            Command::Speed(study) => study.execute(seed)?,
            Command::ImpactCurves(study) => study.execute(seed)?,
            Command::ImpactLimit(study) => study.execute(seed),
            Command::ImpactAccuracy(study) => study.execute(seed),
            Command::ImpactBalance(study) => study.execute(seed),
            Command::SpaceConvergence(study) => study.execute(seed),
            Command::SpaceLaws(study) => study.execute(seed),
            Command::SpaceReferences(study) => study.execute(seed),
            Command::SpaceMissed(study) => study.execute(seed),
            Command::SpaceEnergy(study) => study.execute(seed),
            Command::SpaceStress(study) => study.execute(seed),
            Command::SpaceSpeed(study) => study.execute(seed)?,
            Command::SpaceLanes(study) => study.execute(),
            Command::SpacePeers(study) => study.execute(seed)?,
            Command::SpaceDecision(study) => study.execute(seed)?,
            Command::LinkFuzz(study) => study.execute(seed)?,
            Command::RapierStep(study) => study.execute(seed)?,
            Command::RapierSpeed(study) => study.execute(seed)?,
            Command::RapierEnergy(study) => study.execute(seed)?,
            Command::RapierStress(study) => study.execute(seed),
            Command::RapierRestitution(study) => study.execute()?,
            Command::RobotSoak(study) => study.execute(seed)?,
            Command::Work(work) => return work.execute(),
            Command::RunApart(run) => return run.execute(),
        };
        if let Some((path, file)) = csv {
            report
                .write_csv(file)
                .with_context(|| format!("cannot write {}", path.display()))?;
        }
        write!(io::stdout().lock(), "{report}")?;
        Ok(())
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
        let all = [workloads(), space_workloads()].concat();
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

//! The command line.

use crate::atlas::Atlas;
use crate::calibrate::Calibrate;
use crate::conical::Conical;
use crate::convergence::Convergence;
use crate::energy::Energy;
use crate::film::Film;
use crate::flat_table::FlatTable;
use crate::impacts::{ImpactAccuracy, ImpactBalance, ImpactCurves, ImpactLimit};
use crate::integration::Integration;
use crate::link_fuzz::LinkFuzz;
use crate::listen::Listen;
use crate::missed_contacts::MissedContacts;
use crate::oracle::Oracle;
use crate::rapier::{RapierEnergy, RapierRestitution, RapierStep, RapierStress};
use crate::robot_soak::RobotSoak;
use crate::rough::{RoughStarts, RoughTosses};
use crate::same_side::SameSide;
use crate::space::{SpaceDecision, SpaceLaws, SpacePeers, SpaceReferences};
use crate::stability::Stability;
use crate::stopping_rule::StoppingRule;
use crate::undecided::Undecided;
use clap::{Parser, Subcommand};
use coinmc_bench::Output;

/// Studies of the engines and of the runner: accuracy, bias, robustness.
///
/// Tables go to standard output. The same seed gives the same numbers on any machine, with any
/// number of threads. The variable RAYON_NUM_THREADS sets how many threads a study uses (all cores
/// without it).
#[derive(Debug, Parser)]
#[command(name = "coinmc-studies", version, max_term_width = 100)]
pub(crate) struct Arguments {
    #[command(flatten)]
    output: Output,

    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// P(side) in the scenes of an earlier planar study, and against Chipmunk and Box2D
    FlatTable(FlatTable),
    /// Fits to synthetic film: how often the intervals hold the truth
    Film(Film),
    /// The atlas: networks fitted to the results of a design, and how wrong they are at fresh points
    Atlas(Atlas),
    /// Synthetic coins calibrated: do intervals hold the truth, what does each measurement tell
    Calibrate(Calibrate),
    /// Simulated recordings listened to: rolling friction, restitution, bad files
    Listen(Listen),
    /// How P(side) depends on the engine's settings, toss by toss
    Convergence(Convergence),
    /// Every flight against dense sampling: contacts passed over, energy gained
    MissedContacts(MissedContacts),
    /// The volumetric engine against fixed-step time stepping, toss by toss
    Oracle(Oracle),
    /// Coins whose heads and tails differ, by a conical edge or a load, against time stepping
    Conical(Conical),
    /// Worst gain of energy in impacts and in contact phases
    Energy(Energy),
    /// Tosses without a face at the limit of impacts, and the slowest scenes
    Undecided(Undecided),
    /// How often stopping at a hundredth of the energy names another face
    StoppingRule(StoppingRule),
    /// Adhesive scenes: error of random and Sobol tosses, control variate, quadrature
    Integration(Integration),
    /// Either engine under random tosses from a huge box: errors, gains and limits by region
    Stability(Stability),
    /// Laws of impact: P(side) and the fair ratio under each
    ImpactCurves(ImpactCurves),
    /// Laws of impact: what line contact and half sine become in the stiff limit
    ImpactLimit(ImpactLimit),
    /// Laws of impact: error against run time
    ImpactAccuracy(ImpactAccuracy),
    /// Laws of impact: stress of the line contact, and its balance of energy
    ImpactBalance(ImpactBalance),
    /// In space: P(side) with its total error, by law of impact
    SpaceLaws(SpaceLaws),
    /// In space: the reference values of an earlier study, under its law of impact and ours
    SpaceReferences(SpaceReferences),
    /// In space: P(side) beside what other engines give
    SpacePeers(SpacePeers),
    /// In space: the decision by tilting energy against the rigorous one
    SpaceDecision(SpaceDecision),
    /// Flips of 48 people: how often the same side, and the angle ψ of each
    SameSide(SameSide),
    /// On explicit rough ground, time-stepped: do coins that start rolling or spinning stay upright
    RoughStarts(RoughStarts),
    /// On explicit rough ground, time-stepped: P(side) of whole tosses
    RoughTosses(RoughTosses),
    /// Any bytes on the robot's link: does either end ever break a rule or panic
    LinkFuzz(LinkFuzz),
    /// On Rapier: P(side) against the step, beside the event-driven engine
    RapierStep(RapierStep),
    /// On Rapier: how far the energy rises above its value at launch
    RapierEnergy(RapierEnergy),
    /// On Rapier: random tosses from a huge box of scenes
    RapierStress(RapierStress),
    /// On Rapier: landings and rolling that are known exactly, against the step
    RapierRestitution(RapierRestitution),
    /// A simulated robot through noise, resets, unpluggings and kills: nothing lost or doubled
    RobotSoak(RobotSoak),
}

impl Arguments {
    /// Executes the study.
    pub(crate) fn execute(self) -> anyhow::Result<()> {
        let command = self.command;
        self.output.report(|seed| {
            Ok(match command {
                Command::FlatTable(study) => study.execute(seed),
                Command::Film(study) => study.execute(seed),
                Command::Atlas(study) => study.execute()?,
                Command::Calibrate(study) => study.execute(seed)?,
                Command::Listen(study) => study.execute(seed),
                Command::Convergence(study) => study.execute(seed),
                Command::MissedContacts(study) => study.execute(seed),
                Command::Oracle(study) => study.execute(seed),
                Command::Conical(study) => study.execute(seed),
                Command::Energy(study) => study.execute(seed),
                Command::Undecided(study) => study.execute(seed),
                Command::StoppingRule(study) => study.execute(seed),
                Command::Integration(study) => study.execute(seed),
                Command::Stability(study) => study.execute(seed)?,
                Command::ImpactCurves(study) => study.execute(seed)?,
                Command::ImpactLimit(study) => study.execute(seed),
                Command::ImpactAccuracy(study) => study.execute(seed),
                Command::ImpactBalance(study) => study.execute(seed),
                Command::SpaceLaws(study) => study.execute(seed),
                Command::SpaceReferences(study) => study.execute(seed),
                Command::SpacePeers(study) => study.execute(seed)?,
                Command::SpaceDecision(study) => study.execute(seed)?,
                Command::SameSide(study) => study.execute(seed)?,
                Command::RoughStarts(study) => study.execute(seed),
                Command::RoughTosses(study) => study.execute(seed)?,
                Command::LinkFuzz(study) => study.execute(seed)?,
                Command::RapierStep(study) => study.execute(seed)?,
                Command::RapierEnergy(study) => study.execute(seed)?,
                Command::RapierStress(study) => study.execute(seed),
                Command::RapierRestitution(study) => study.execute()?,
                Command::RobotSoak(study) => study.execute(seed)?,
            })
        })
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

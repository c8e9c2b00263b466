//! `coinmc robot …`: the coin-tossing robot, real or simulated.

mod camera_sim;
mod export;
mod fairness;
mod ports;
mod progress_line;
mod query;
mod run;
mod sim;
mod stop;
mod throw;

use crate::exit::{Failure, Outcome};
use crate::output::{Console, Format};
use anyhow::anyhow;
use clap::{Args, Subcommand};
use coinmc_robot::cycle::Halt;
use coinmc_robot::journal::History;
use coinmc_robot::port::ConnectionError;
use coinmc_robot::{Directory, DirectoryError, Experiment, SessionError};
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  coinmc robot ports                              list the serial ports
  coinmc robot throw --spin 3.2 --angle 90        throw once, outside any experiment
  coinmc robot run examples/robot.toml --out day --camera 'my-camera --usb 0'
  coinmc robot resume day                         continue after any interruption
  coinmc robot stop day                           motors off, at once
  coinmc robot export day                         write throws and results as CSV and Parquet
  coinmc robot fairness day                       test whether the robot is fair

To try it with a simulated robot, see `coinmc robot sim --help` and docs/guide/robot.md.";

/// Throw real coins: run the coin-tossing robot, or a simulated one
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Robot {
    #[command(subcommand)]
    command: Command,
}

/// The help of each is with its arguments.
#[derive(Debug, Subcommand)]
enum Command {
    Ports(ports::Ports),
    Info(query::Info),
    Status(query::Status),
    Home(query::Home),
    Stop(stop::Stop),
    Clear(stop::Clear),
    Throw(throw::Throw),
    Run(run::Run),
    Resume(run::Resume),
    Export(export::Export),
    Fairness(fairness::Fairness),
    Sim(sim::Sim),
    CameraSim(camera_sim::CameraSim),
}

impl Robot {
    pub(crate) fn format(&self) -> Format {
        match &self.command {
            Command::Ports(ports) => ports.format,
            Command::Info(info) => info.target.format,
            Command::Status(status) => status.target.format,
            Command::Run(run) => run.session.format,
            Command::Resume(resume) => resume.session.format,
            Command::Fairness(fairness) => fairness.format,
            Command::Export(_)
            | Command::Home(_)
            | Command::Stop(_)
            | Command::Clear(_)
            | Command::Throw(_)
            | Command::Sim(_)
            | Command::CameraSim(_) => Format::Table,
        }
    }

    pub(crate) fn execute(&self, console: &Console) -> Result<Outcome, Failure> {
        match &self.command {
            Command::Ports(_) => ports::Ports::execute(console),
            Command::Info(info) => info.execute(console),
            Command::Status(status) => status.execute(console),
            Command::Home(home) => home.execute(),
            Command::Stop(stop) => stop.execute(),
            Command::Clear(clear) => clear.execute(),
            Command::Throw(throw) => throw.execute(),
            Command::Run(run) => run.execute(console),
            Command::Resume(resume) => resume.execute(console),
            Command::Export(export) => export.execute(),
            Command::Fairness(fairness) => fairness.execute(console),
            Command::Sim(sim) => sim.execute(),
            Command::CameraSim(camera) => camera.execute(),
        }
    }
}

/// The robot's port.
#[derive(Debug, Args)]
struct PortArgument {
    /// The robot's serial port [default: the only one with a stable name]
    #[arg(long, value_name = "PATH")]
    port: Option<PathBuf>,
}

impl PortArgument {
    /// The port that was given, or the only one with a stable name.
    fn port(&self) -> Result<PathBuf, Failure> {
        if let Some(port) = &self.port {
            return Ok(port.clone());
        }
        let found = coinmc_robot::port::ports().map_err(|error| Failure::Runtime(error.into()))?;
        let mut stable = found.into_iter().filter(|entry| entry.stable);
        match (stable.next(), stable.next()) {
            (Some(only), None) => Ok(only.path),
            (None, _) => Err(Failure::Input(anyhow!(
                "no robot is plugged in: no serial port has a stable name. Give one with --port \
                 (`coinmc robot ports` lists all), or start `coinmc robot sim`"
            ))),
            _ => Err(Failure::Input(anyhow!(
                "there are several serial ports with stable names: choose one with --port (`coinmc \
                 robot ports` lists them)"
            ))),
        }
    }
}

/// The experiment in a directory and its journal, even while it is running.
pub(in crate::commands) fn read(path: &Path) -> Result<(Experiment, History), Failure> {
    Directory::at(path).read().map_err(failure)
}

/// Classifies an error: wrong input by the user, or a failure at run time.
fn failure(error: impl Into<anyhow::Error>) -> Failure {
    use coinmc_robot::journal::JournalError as Journal;
    let error = error.into();
    let journal = |journal: &Journal| {
        matches!(
            journal,
            Journal::Damaged { .. } | Journal::OtherExperiment { .. } | Journal::TooLong { .. }
        )
    };
    let connection = |error: &ConnectionError| {
        matches!(
            error,
            ConnectionError::Port(_)
                | ConnectionError::OtherVersion(_)
                | ConnectionError::Request(_)
        )
    };
    let session = error.downcast_ref().is_some_and(|error| match error {
        SessionError::Journal(error) => journal(error),
        SessionError::Connection(error) => connection(error),
        SessionError::Halt(halt) => is_input(halt),
        _ => false,
    });
    let halted = matches!(error.downcast_ref(), Some(SessionError::Halt(halt)) if !is_input(halt));
    let directory = error.downcast_ref().is_some_and(|error| match error {
        DirectoryError::Journal(error) => journal(error),
        DirectoryError::Io { .. } => false,
        _ => true,
    });
    let connection = error.downcast_ref().is_some_and(connection);
    if session || directory || connection {
        Failure::Input(error)
    } else if halted {
        Failure::Halted(error)
    } else {
        Failure::Runtime(error)
    }
}

/// Whether a halt means that experiment and robot do not belong together.
fn is_input(halt: &Halt) -> bool {
    matches!(
        halt,
        Halt::Ahead { .. }
            | Halt::Foreign { .. }
            | Halt::OutOfRange { .. }
            | Halt::OutOfReach { .. }
    )
}

//! `coinmc robot stop` and `clear`: the motors off at once, and ready again.

use super::PortArgument;
use super::query::{Robot, wrong_reply};
use crate::exit::{Failure, Outcome};
use crate::output;
use anyhow::anyhow;
use clap::Args;
use coinmc_link::{Reply, Request, State};
use coinmc_robot::Directory;
use std::path::PathBuf;
use std::thread::sleep;
use std::time::{Duration, Instant};

/// The robot itself stops 5 s after its host; the host waits 6 s for its answer.
const PATIENCE: Duration = Duration::from_secs(15);

/// Switch the robot's motors off at once
///
/// With the directory of a running experiment, its host is told to do so: it holds the port. The open
/// throw has no result then. Nothing else is lost, and `resume` continues.
#[derive(Debug, Args)]
pub(super) struct Stop {
    /// Directory of the experiment that runs
    #[arg(value_name = "DIR")]
    directory: Option<PathBuf>,

    #[command(flatten)]
    port: PortArgument,
}

/// Clear the robot's fault, after a look at it; also that of a released emergency stop
#[derive(Debug, Args)]
pub(super) struct Clear {
    #[command(flatten)]
    port: PortArgument,
}

impl Stop {
    pub(super) fn execute(&self) -> Result<Outcome, Failure> {
        if let Some(path) = &self.directory {
            let directory = Directory::at(path);
            if let Some(host) = directory.host() {
                return stop_host(&directory, host);
            }
        }
        let stored = self.directory.as_ref().and_then(|path| {
            let setup = Directory::at(path).setup()?;
            Some(setup.port)
        });
        let port = PortArgument {
            port: self.port.port.clone().or(stored),
        };
        let mut robot = Robot::connect(&port).map_err(|failure| match failure {
            Failure::Input(error) if self.directory.is_none() => Failure::Input(anyhow!(
                "{error}. If an experiment runs, give its directory: `coinmc robot stop DIR`"
            )),
            other => other,
        })?;
        match robot.request(&Request::Stop)? {
            Reply::Ok { .. } => output::note("the robot's motors are off"),
            _ => return Err(wrong_reply()),
        }
        Ok(Outcome::Done)
    }
}

/// Sends the host what two Ctrl-C send, and waits for its end.
fn stop_host(directory: &Directory, process: u32) -> Result<Outcome, Failure> {
    let begun = Instant::now();
    for _ in 0..2 {
        if let Err(error) = directory.interrupt_host(process)
            && directory.host().is_some()
        {
            return Err(Failure::Runtime(anyhow!(
                "cannot stop process {process} ({error}): press Ctrl-C twice where it runs, or the \
                 emergency stop"
            )));
        }
        // two signals at once would be one
        sleep(Duration::from_millis(50));
    }
    while directory.host().is_some() {
        if begun.elapsed() > PATIENCE {
            return Err(Failure::Runtime(anyhow!(
                "process {process} has not stopped: press the emergency stop. Without its host the \
                 robot stops by itself within 5 s"
            )));
        }
        sleep(Duration::from_millis(50));
    }
    output::note(&format!(
        "the host (process {process}) has stopped the robot and ended"
    ));
    Ok(Outcome::Done)
}

impl Clear {
    pub(super) fn execute(&self) -> Result<Outcome, Failure> {
        let mut robot = Robot::connect(&self.port)?;
        let status = robot.status()?;
        if status.state != State::Fault {
            output::note(&format!(
                "the robot has no fault: {}",
                coinmc_robot::state_name(status.state)
            ));
            return Ok(Outcome::Done);
        }
        let code = status.fault;
        let text = coinmc_robot::fault_text(code);
        match robot.request(&Request::ClearFault { code })? {
            Reply::Ok { .. } if robot.status()?.state != State::Fault => {
                output::note(&format!("{text} is cleared"));
                Ok(Outcome::Done)
            }
            Reply::Nak(coinmc_link::Nak::Busy) => Err(Failure::Runtime(anyhow!(
                "{text} cannot be cleared: the emergency stop is still pressed"
            ))),
            _ => Err(Failure::Runtime(anyhow!("{text} stays"))),
        }
    }
}

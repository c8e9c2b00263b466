//! `coinmc robot info`, `status` and `home`: one question to the robot.

use super::{PortArgument, failure};
use crate::exit::{Failure, Outcome};
use crate::output::{self, Console, FORMAT_VERSION, Format};
use anyhow::anyhow;
use clap::Args;
use coinmc_link::{Greeting, Reply, Request, State, axis, capability};
use coinmc_robot::Clock;
use coinmc_robot::port::{Answer, Connection};
use serde_json::json;
use std::time::{Duration, Instant};

/// How long a robot is waited for.
const PATIENCE: Duration = Duration::from_secs(10);

#[derive(Debug, Args)]
pub(super) struct At {
    #[command(flatten)]
    port: PortArgument,

    /// How to write the answer
    #[arg(long, value_enum, default_value_t = Format::Table)]
    pub(super) format: Format,
}

/// Show what the robot is and can reach
#[derive(Debug, Args)]
pub(super) struct Info {
    #[command(flatten)]
    pub(super) at: At,
}

/// Show where the robot is
#[derive(Debug, Args)]
pub(super) struct Status {
    #[command(flatten)]
    pub(super) at: At,
}

/// Let all axes find their end stops
#[derive(Debug, Args)]
pub(super) struct Home {
    #[command(flatten)]
    port: PortArgument,
}

impl Info {
    pub(super) fn execute(&self, console: &Console) -> Result<Outcome, Failure> {
        let mut robot = Robot::connect(&self.at.port)?;
        let Reply::Info(info) = robot.ask(&Request::Info)? else {
            return Err(out_of_turn());
        };
        let uid = format!("{:016x}", u64::from_be_bytes(info.uid));
        let [major, minor, patch] = info.firmware;
        let has = |bit| info.capabilities & bit != 0;
        let (limits, version) = (info.limits, robot.greeting.version);
        let (spin, angle) = (
            f64::from(limits.spin_mrev_s) / 1e3,
            f64::from(limits.angle_cdeg) / 1e2,
        );
        match console.format() {
            Format::Json => output::print_json(&json!({
                "format_version": FORMAT_VERSION,
                "kind": "robot-info",
                "uid": uid,
                "firmware": format!("{major}.{minor}.{patch}"),
                "protocol": format!("{}.{}", version.major, version.minor),
                "light": has(capability::LIGHT),
                "carriage": has(capability::CARRIAGE),
                "max_spin_rev_s": spin,
                "max_angle_deg": angle,
                "max_x_m": f64::from(limits.x_um) / 1e6,
                "max_y_m": f64::from(limits.y_um) / 1e6,
            })),
            Format::Table => output::print(&format!(
                "robot     {uid}\n\
                 firmware  {major}.{minor}.{patch}, protocol {}.{}\n\
                 reaches   spin 0 to {spin} rev/s, angle 0 to {angle} degrees, \
                 carriage ±{} by ±{} mm\n\
                 has       lamp: {}, carriage by hand: {}\n",
                version.major,
                version.minor,
                limits.x_um / 1000,
                limits.y_um / 1000,
                yes(has(capability::LIGHT)),
                yes(has(capability::CARRIAGE)),
            )),
        }
        .map_err(|error| Failure::Runtime(error.into()))?;
        Ok(Outcome::Done)
    }
}

impl Status {
    pub(super) fn execute(&self, console: &Console) -> Result<Outcome, Failure> {
        let mut robot = Robot::connect(&self.at.port)?;
        let status = robot.status()?;
        let (spin, angle) = (
            f64::from(status.meas_spin_mrev_s) / 1e3,
            f64::from(status.meas_angle_cdeg) / 1e2,
        );
        match console.format() {
            Format::Json => output::print_json(&json!({
                "format_version": FORMAT_VERSION,
                "kind": "robot-status",
                "state": coinmc_robot::name(status.state),
                "throw_id": status.throw_id,
                "released": status.released,
                "boot": robot.greeting.boot,
                "measured_spin_rev_s": spin,
                "measured_angle_deg": angle,
                "x_m": f64::from(status.x_um) / 1e6,
                "y_m": f64::from(status.y_um) / 1e6,
                "up_s": f64::from(status.t_ms) / 1e3,
                "fault": status.fault,
                "bad_frames": status.rx_bad,
            })),
            Format::Table => output::print(&format!(
                "state     {}\nthrow     {}{}\nmeasured  {spin} rev/s, {angle} degrees\n\
                 carriage  {} by {} mm\nrunning   {:.1} s since start {}, {} bad frames\n",
                if status.state == State::Fault {
                    coinmc_robot::fault(status.fault)
                } else {
                    coinmc_robot::name(status.state).to_owned()
                },
                status.throw_id,
                if status.released {
                    ", coin released"
                } else {
                    ""
                },
                status.x_um / 1000,
                status.y_um / 1000,
                f64::from(status.t_ms) / 1e3,
                robot.greeting.boot,
                status.rx_bad,
            )),
        }
        .map_err(|error| Failure::Runtime(error.into()))?;
        Ok(Outcome::Done)
    }
}

impl Home {
    pub(super) fn execute(&self) -> Result<Outcome, Failure> {
        let mut robot = Robot::connect(&self.port)?;
        match robot.ask(&Request::Home { axes: axis::ALL })? {
            Reply::Ok { .. } => output::note("the robot finds its end stops"),
            Reply::Nak(nak) => {
                let state = robot.status()?.state;
                return Err(Failure::Runtime(anyhow!(
                    "the robot does not go home: {nak} (it is {})",
                    coinmc_robot::name(state)
                )));
            }
            _ => return Err(out_of_turn()),
        }
        Ok(Outcome::Done)
    }
}

/// A robot that is asked a few things.
pub(super) struct Robot {
    connection: Connection,
    greeting: Greeting,
}

impl Robot {
    pub(super) fn connect(port: &PortArgument) -> Result<Self, Failure> {
        let path = port.port()?;
        let opened = Connection::open(&path, Clock::new(1.0));
        let mut connection =
            opened.map_err(|error| failure(coinmc_robot::port::ConnectionError::Port(error)))?;
        let begun = Instant::now();
        let late = || begun.elapsed() > PATIENCE;
        match connection.connect(&late, &mut |_| {}).map_err(failure)? {
            Answer::Connected { greeting, .. } => Ok(Self {
                connection,
                greeting,
            }),
            _ => Err(silent()),
        }
    }

    /// Asks, again if the session was opened anew.
    pub(super) fn ask(&mut self, request: &Request) -> Result<Reply, Failure> {
        let begun = Instant::now();
        let late = || begun.elapsed() > PATIENCE;
        loop {
            let answer = self.connection.ask(request, &late, &mut |_| {});
            match answer.map_err(failure)? {
                Answer::Reply(reply) => return Ok(reply),
                Answer::Connected { greeting, .. } => self.greeting = greeting,
                Answer::GivenUp => return Err(silent()),
            }
        }
    }

    pub(super) fn status(&mut self) -> Result<coinmc_link::Status, Failure> {
        match self.ask(&Request::Status)? {
            Reply::Status(status) => Ok(status),
            _ => Err(out_of_turn()),
        }
    }
}

fn silent() -> Failure {
    Failure::Runtime(anyhow!(
        "the robot does not answer: is it switched on, and is this its port?"
    ))
}

pub(super) fn out_of_turn() -> Failure {
    Failure::Runtime(anyhow!(
        "the robot answered another question than was asked"
    ))
}

fn yes(yes: bool) -> &'static str {
    if yes { "yes" } else { "no" }
}

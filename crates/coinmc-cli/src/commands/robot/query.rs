//! `coinmc robot info`, `status` and `home`: single requests to the robot.

use super::{PortArgument, failure};
use crate::exit::{Failure, Outcome};
use crate::output::{self, Console, FORMAT_VERSION, Format};
use anyhow::anyhow;
use clap::Args;
use coinmc_link::{Greeting, Reply, Request, State, axis, capability};
use coinmc_robot::Clock;
use coinmc_robot::port::{Connection, RequestOutcome};
use serde_json::json;
use std::time::{Duration, Instant};

/// Time limit for a reply of the robot.
const REPLY_TIMEOUT: Duration = Duration::from_secs(10);

#[derive(Debug, Args)]
pub(super) struct PortAndFormat {
    #[command(flatten)]
    port: PortArgument,

    /// Format of the output
    #[arg(long, value_enum, default_value_t = Format::Table)]
    pub(super) format: Format,
}

/// Show the robot's version, limits and capabilities
#[derive(Debug, Args)]
pub(super) struct Info {
    #[command(flatten)]
    pub(super) target: PortAndFormat,
}

/// Show the robot's state
#[derive(Debug, Args)]
pub(super) struct Status {
    #[command(flatten)]
    pub(super) target: PortAndFormat,
}

/// Move all axes to their end stops
#[derive(Debug, Args)]
pub(super) struct Home {
    #[command(flatten)]
    port: PortArgument,
}

impl Info {
    pub(super) fn execute(&self, console: &Console) -> Result<Outcome, Failure> {
        let mut robot = Robot::connect(&self.target.port)?;
        let Reply::Info(info) = robot.request(&Request::Info)? else {
            return Err(wrong_reply());
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
                 has       lamp: {}, movable carriage: {}\n",
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
        let mut robot = Robot::connect(&self.target.port)?;
        let status = robot.status()?;
        let (spin, angle) = (
            f64::from(status.meas_spin_mrev_s) / 1e3,
            f64::from(status.meas_angle_cdeg) / 1e2,
        );
        match console.format() {
            Format::Json => output::print_json(&json!({
                "format_version": FORMAT_VERSION,
                "kind": "robot-status",
                "state": coinmc_robot::state_name(status.state),
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
                    coinmc_robot::fault_text(status.fault)
                } else {
                    coinmc_robot::state_name(status.state).to_owned()
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
        match robot.request(&Request::Home { axes: axis::ALL })? {
            Reply::Ok { .. } => output::note("the robot is moving to its end stops"),
            Reply::Nak(nak) => {
                let state = robot.status()?.state;
                return Err(Failure::Runtime(anyhow!(
                    "the robot does not move to its end stops: {nak} (its state: {})",
                    coinmc_robot::state_name(state)
                )));
            }
            _ => return Err(wrong_reply()),
        }
        Ok(Outcome::Done)
    }
}

/// A connection for a few requests.
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
        let started = Instant::now();
        let late = || started.elapsed() > REPLY_TIMEOUT;
        match connection.connect(&late, &mut |_| {}).map_err(failure)? {
            RequestOutcome::Connected { greeting, .. } => Ok(Self {
                connection,
                greeting,
            }),
            _ => Err(no_reply()),
        }
    }

    /// Sends a request, again if the session was opened again.
    pub(super) fn request(&mut self, request: &Request) -> Result<Reply, Failure> {
        let started = Instant::now();
        let late = || started.elapsed() > REPLY_TIMEOUT;
        loop {
            let outcome = self.connection.request(request, &late, &mut |_| {});
            match outcome.map_err(failure)? {
                RequestOutcome::Reply(reply) => return Ok(reply),
                RequestOutcome::Connected { greeting, .. } => self.greeting = greeting,
                RequestOutcome::GivenUp => return Err(no_reply()),
            }
        }
    }

    pub(super) fn status(&mut self) -> Result<coinmc_link::Status, Failure> {
        match self.request(&Request::Status)? {
            Reply::Status(status) => Ok(status),
            _ => Err(wrong_reply()),
        }
    }
}

fn no_reply() -> Failure {
    Failure::Runtime(anyhow!(
        "the robot does not reply: is it switched on, and is this its port?"
    ))
}

pub(super) fn wrong_reply() -> Failure {
    Failure::Runtime(anyhow!("the robot's reply does not belong to the request"))
}

fn yes(yes: bool) -> &'static str {
    if yes { "yes" } else { "no" }
}

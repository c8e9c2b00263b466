//! `coinmc robot throw`: a single throw.

use super::PortArgument;
use super::query::{Robot, wrong_reply};
use crate::exit::{Failure, Outcome};
use crate::output;
use anyhow::anyhow;
use clap::Args;
use coinmc_link::{Reply, Request, State};
use coinmc_robot::Setting;
use std::thread;

/// Throw once, outside any experiment
///
/// The robot counts the throw as one of no experiment, so an experiment with a journal then has to be continued with
/// `--adopt`. The coin is collected afterwards.
#[derive(Debug, Args)]
pub(super) struct Throw {
    /// Spin, rev/s, 0 to 5
    #[arg(long, value_name = "REV_S", allow_negative_numbers = true)]
    spin: f64,

    /// Start angle of the coin's axis from the vertical, degrees, 0 (heads up) to 180
    #[arg(long, value_name = "DEG", allow_negative_numbers = true)]
    angle: f64,

    #[command(flatten)]
    port: PortArgument,
}

impl Throw {
    pub(super) fn execute(&self) -> Result<Outcome, Failure> {
        let setting = Setting::nearest(self.spin, self.angle)
            .map_err(|error| Failure::Input(error.into()))?;
        let mut robot = Robot::connect(&self.port)?;
        let status = robot.status()?;
        if status.state != State::Idle {
            return Err(Failure::Runtime(anyhow!(
                "the robot is not ready: {} at throw {}. Let it finish, or resume its experiment",
                coinmc_robot::state_name(status.state),
                status.throw_id
            )));
        }
        let throw_id = status.throw_id.saturating_add(1);
        let request = Request::Throw {
            throw_id,
            experiment: 0,
            spin_mrev_s: setting.spin_mrev_s(),
            angle_cdeg: setting.angle_cdeg(),
        };
        if let Reply::Nak(nak) = robot.request(&request)? {
            return Err(Failure::Runtime(anyhow!("the robot does not throw: {nak}")));
        }
        let at_coin = wait_for(&mut robot, throw_id, State::AtCoin)?;
        output::note(&format!(
            "throw {throw_id}: released with {} rev/s from {} degrees; the coin lies at {} by {} mm",
            f64::from(at_coin.meas_spin_mrev_s) / 1e3,
            f64::from(at_coin.meas_angle_cdeg) / 1e2,
            at_coin.x_um / 1000,
            at_coin.y_um / 1000,
        ));
        match robot.request(&Request::Collect { throw_id })? {
            Reply::Ok { .. } => {}
            Reply::Nak(nak) => {
                return Err(Failure::Runtime(anyhow!(
                    "the coin is not collected: {nak}"
                )));
            }
            _ => return Err(wrong_reply()),
        }
        wait_for(&mut robot, throw_id, State::Idle)?;
        Ok(Outcome::Done)
    }
}

/// Waits until the robot is in a state; fails if it goes to Fault or abandons the throw.
fn wait_for(robot: &mut Robot, throw_id: u32, goal: State) -> Result<coinmc_link::Status, Failure> {
    loop {
        let status = robot.status()?;
        if status.throw_id != throw_id {
            return Err(Failure::Runtime(anyhow!(
                "the robot is at throw {}, not {throw_id}: another program uses it",
                status.throw_id
            )));
        }
        if status.state == goal {
            return Ok(status);
        }
        if matches!(status.state, State::Fault | State::Idle) {
            return Err(Failure::Runtime(anyhow!(
                "throw {throw_id} failed: {}",
                if status.state == State::Fault {
                    coinmc_robot::fault_text(status.fault)
                } else {
                    "the robot abandoned it".to_owned()
                }
            )));
        }
        thread::sleep(coinmc_robot::POLL);
    }
}

//! `coinmc robot sim`: a simulated robot.

use crate::exit::{Failure, Outcome};
use crate::interrupt;
use crate::output;
use clap::Args;
use coinmc::config::{self, Override};
use coinmc_robot::Experiment;
use coinmc_robot::sim::{Command, Faults, SimError, SimOptions, simulate};
use std::io;
use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::sync::mpsc::{self, Sender};
use std::thread;

const EXAMPLES: &str = "\
Example, in two terminals:
  coinmc robot sim examples/robot.toml --name robot-port --truth truth.jsonl --speed 100
  coinmc robot run examples/robot.toml --port robot-port --speed 100 --out day \\
      --camera 'coinmc robot camera-sim --truth truth.jsonl'

While it runs it obeys lines on standard input: reset, cut (a reset while it writes its next record), \
unplug [SECONDS], stick, press and release (the emergency stop), erase (the memory), swap (another \
robot in its place), quit.";

/// Simulate a robot on a pseudo-terminal, with faults on demand
///
/// The first line on standard output is the path to give as --port. The config's engine simulates
/// the coin with the spin and angle of each throw.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Sim {
    /// The config of the experiment
    config: PathBuf,

    /// Replace or add a value of the config; repeatable
    #[arg(long = "set", value_name = "KEY=VALUE")]
    overrides: Vec<Override>,

    /// A stable name for the port: a symbolic link to create, which stays the same when the robot
    /// is unplugged
    #[arg(long, value_name = "PATH")]
    name: Option<PathBuf>,

    /// Append the true outcomes to this file, for `camera-sim`
    #[arg(long, value_name = "FILE")]
    truth: Option<PathBuf>,

    /// Keep the robot's counter in this file [default: none, the counter starts at 0]
    #[arg(long, value_name = "FILE")]
    memory: Option<PathBuf>,

    /// Speed relative to real time
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = speed)]
    speed: f64,

    /// Fraction of bytes, each way, that are damaged, dropped or followed by a random byte
    #[arg(long, value_name = "FRACTION", default_value_t = 0.0, value_parser = fraction)]
    noise: f64,

    /// Fraction of frames, each way, that are dropped, doubled, swapped, delayed, cut, sent again later
    /// or preceded by a forged one
    #[arg(long, value_name = "FRACTION", default_value_t = 0.0, value_parser = fraction)]
    hostile: f64,

    /// Fraction of answers preceded by a forged one, to the same request but about another throw or
    /// experiment or of an earlier time: the host may stop and ask, and must not record a wrong face
    #[arg(long, value_name = "FRACTION", default_value_t = 0.0, value_parser = fraction)]
    forged: f64,

    /// Fraction of motions that never end
    #[arg(long, value_name = "FRACTION", default_value_t = 0.0, value_parser = fraction)]
    stuck: f64,

    /// Mean time between resets, seconds in the robot's time
    #[arg(long, value_name = "S", value_parser = seconds)]
    reset_every: Option<f64>,

    /// Mean time between disconnections, seconds in the robot's time
    #[arg(long, value_name = "S", value_parser = seconds)]
    unplug_every: Option<f64>,

    /// Seed of all random numbers
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

impl Sim {
    pub(super) fn execute(&self) -> Result<Outcome, Failure> {
        let plan = config::load(&self.config, &self.overrides)?;
        let experiment = Experiment::new(plan).map_err(|e| Failure::Input(e.into()))?;
        let cancel = interrupt::listen(|| {})?;
        let (sender, commands) = mpsc::channel();
        thread::spawn(move || read_commands(&sender));
        let options = SimOptions {
            name: self.name.clone(),
            truth: self.truth.clone(),
            memory: self.memory.clone(),
            speed: self.speed,
            faults: Faults {
                noise: self.noise,
                hostile: self.hostile,
                forged: self.forged,
                reset_every_s: self.reset_every,
                unplug_every_s: self.unplug_every,
                stuck: self.stuck,
            },
            seed: self.seed,
        };
        let ready = |path: &std::path::Path| {
            // ignore a closed output: the host finds the port by its name
            let _ = output::print(&format!("{}\n", path.display()));
        };
        let ended = || cancel.load(Ordering::Relaxed);
        simulate(experiment, &options, &commands, ready, &ended).map_err(|error| match error {
            SimError::NameTaken(_) => Failure::Input(error.into()),
            _ => Failure::Runtime(error.into()),
        })?;
        Ok(Outcome::Done)
    }
}

/// Passes on commands from standard input until it ends.
fn read_commands(to: &Sender<Command>) {
    for line in io::stdin().lines() {
        let Ok(line) = line else { return };
        match line.parse() {
            Ok(command) => {
                if to.send(command).is_err() {
                    return;
                }
            }
            Err(error) => output::note(&format!("{error}")),
        }
    }
}

pub(super) fn fraction(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(share) if (0.0..=1.0).contains(&share) => Ok(share),
        _ => Err("a fraction is a number from 0 to 1".to_owned()),
    }
}

pub(super) fn speed(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(speed) if (1.0..=10_000.0).contains(&speed) => Ok(speed),
        _ => Err("a speed is a number from 1 (real time) to 10000".to_owned()),
    }
}

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(seconds) if seconds > 0.0 && seconds < 1e9 => Ok(seconds),
        _ => Err("a time is a positive number of seconds".to_owned()),
    }
}

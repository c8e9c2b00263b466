//! `coinmc robot sim`: a robot where there is none.

use crate::exit::{Failure, Outcome};
use crate::interrupt;
use crate::output;
use anyhow::Context;
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

While it runs it obeys lines on standard input: reset, unplug [SECONDS], stick, quit.";

/// Simulate a robot on a pseudo-terminal, with faults on demand
///
/// The first line on standard output is the path to give as --port. The coin falls as the config's
/// engine says for the spin and angle of each throw.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Sim {
    /// The config of the experiment
    config: PathBuf,

    /// Replace or add a value of the config; repeatable
    #[arg(long = "set", value_name = "KEY=VALUE")]
    overrides: Vec<Override>,

    /// A name for the port that stays when the robot is unplugged; a link made here
    #[arg(long, value_name = "PATH")]
    name: Option<PathBuf>,

    /// Append what really happened to this file; `camera-sim` looks at it
    #[arg(long, value_name = "FILE")]
    truth: Option<PathBuf>,

    /// Keep the robot's memory of its counter in this file [default: none, it begins blank]
    #[arg(long, value_name = "FILE")]
    memory: Option<PathBuf>,

    /// How much faster than life everything moves
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = speed)]
    speed: f64,

    /// Share of bytes, each way, that are flipped, dropped or followed by another
    #[arg(long, value_name = "SHARE", default_value_t = 0.0, value_parser = share)]
    noise: f64,

    /// Share of motions that never end
    #[arg(long, value_name = "SHARE", default_value_t = 0.0, value_parser = share)]
    stuck: f64,

    /// Mean time between resets, seconds of the robot's time
    #[arg(long, value_name = "S", value_parser = seconds)]
    reset_every: Option<f64>,

    /// Mean time between unpluggings, seconds of the robot's time
    #[arg(long, value_name = "S", value_parser = seconds)]
    unplug_every: Option<f64>,

    /// Key of all chance
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

impl Sim {
    pub(super) fn execute(&self) -> Result<Outcome, Failure> {
        let plan = config::load(&self.config, &self.overrides)?;
        let experiment = Experiment::new(plan).map_err(|e| Failure::Input(e.into()))?;
        let cancel = interrupt::listen(|| {})
            .context("cannot listen for signals")
            .map_err(Failure::Runtime)?;
        let (sender, commands) = mpsc::channel();
        thread::spawn(move || obey(&sender));
        let options = SimOptions {
            name: self.name.clone(),
            truth: self.truth.clone(),
            memory: self.memory.clone(),
            speed: self.speed,
            faults: Faults {
                noise: self.noise,
                reset_every_s: self.reset_every,
                unplug_every_s: self.unplug_every,
                stuck: self.stuck,
            },
            seed: self.seed,
        };
        let ready = |path: &std::path::Path| {
            // nobody to tell: the host finds the port by its name
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

/// Hands on commands from standard input, as long as there are any.
fn obey(to: &Sender<Command>) {
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

pub(super) fn share(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(share) if (0.0..=1.0).contains(&share) => Ok(share),
        _ => Err("a share is a number from 0 to 1".to_owned()),
    }
}

pub(super) fn speed(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(speed) if (1.0..=10_000.0).contains(&speed) => Ok(speed),
        _ => Err("a speed is a number from 1 (life) to 10000".to_owned()),
    }
}

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(seconds) if seconds > 0.0 && seconds < 1e9 => Ok(seconds),
        _ => Err("a time is a positive number of seconds".to_owned()),
    }
}

//! The main loop of the simulated robot.

use super::dice::Dice;
use super::line::Noise;
use super::memory::Memory;
use super::nemesis::Nemesis;
use super::plant::Plant;
use super::pty::{Pty, StableName};
use super::truth::TruthFile;
use crate::Experiment;
use coinmc_link::Device;
use std::io;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::sync::mpsc::{Receiver, TryRecvError};
use std::thread;
use std::time::{Duration, Instant};
use thiserror::Error;

/// Longest time between two ticks of the device.
const TICK: Duration = Duration::from_millis(5);

/// Probability that the robot loses power when the cable is unplugged.
const POWERED_BY_CABLE: f64 = 0.5;

/// When the robot's clock wraps.
const WRAPS_AFTER_MS: u32 = 2_000;

/// Options of a simulated robot.
#[derive(Debug, Clone, PartialEq)]
pub struct SimOptions {
    /// A stable name for the port: a symbolic link that the simulation creates and removes.
    pub name: Option<PathBuf>,
    /// The truth file; see [`Truth`](super::Truth).
    pub truth: Option<PathBuf>,
    /// File for the robot's counter; without one it starts at zero.
    pub memory: Option<PathBuf>,
    /// Speed relative to real time.
    pub speed: f64,
    /// Random faults.
    pub faults: Faults,
    /// Seed of all random numbers.
    pub seed: u64,
}

/// Random faults.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Faults {
    /// Fraction of bytes that are damaged, dropped or followed by a random byte.
    pub noise: f64,
    /// Fraction of frames that are attacked; see [`Nemesis`].
    pub hostile: f64,
    /// Fraction of answers that are preceded by a forged one.
    pub forged: f64,
    /// Mean time between resets, s in the robot's time; `None`: never.
    pub reset_every_s: Option<f64>,
    /// Mean time between disconnections, likewise.
    pub unplug_every_s: Option<f64>,
    /// Fraction of motions that never end.
    pub stuck: f64,
}

/// Commands to the simulation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Command {
    /// Reset the robot.
    Reset,
    /// Reset the robot while it writes its next record, after any number of bytes.
    Cut,
    /// Unplug the cable for this time, s in the robot's time.
    Unplug(f64),
    /// Make the next motion never end.
    Stick,
    /// Press the emergency stop.
    Press,
    /// Release the emergency stop.
    Release,
    /// Erase the memory and reset the robot.
    Erase,
    /// Put another robot in its place.
    Swap,
    /// End the simulation.
    Quit,
}

/// Not a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("commands are: reset, cut, unplug [SECONDS], stick, press, release, erase, swap, quit")]
pub struct UnknownCommand;

impl FromStr for Command {
    type Err = UnknownCommand;

    fn from_str(text: &str) -> Result<Self, UnknownCommand> {
        let words: Vec<&str> = text.split_whitespace().collect();
        Ok(match words[..] {
            ["reset"] => Self::Reset,
            ["cut"] => Self::Cut,
            ["unplug"] => Self::Unplug(UNPLUGGED_S),
            ["unplug", seconds] => match seconds.parse() {
                Ok(seconds) if (0.0..=3600.0).contains(&seconds) => Self::Unplug(seconds),
                _ => return Err(UnknownCommand),
            },
            ["stick"] => Self::Stick,
            ["press"] => Self::Press,
            ["release"] => Self::Release,
            ["erase"] => Self::Erase,
            ["swap"] => Self::Swap,
            ["quit"] => Self::Quit,
            _ => return Err(UnknownCommand),
        })
    }
}

/// Default time for which the cable is unplugged, s.
const UNPLUGGED_S: f64 = 2.0;

/// Why a simulation ends.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SimError {
    /// The name belongs to something other than a symbolic link.
    #[error("{} exists and is not a link of a simulated robot: choose another name", .0.display())]
    NameTaken(PathBuf),
    /// A system error.
    #[error("cannot {action}: {error}")]
    Io {
        /// The failed action.
        action: String,
        /// The system's error.
        error: io::Error,
    },
}

fn cannot(action: impl Into<String>) -> impl FnOnce(io::Error) -> SimError {
    let action = action.into();
    move |error| SimError::Io { action, error }
}

/// Simulates a robot until a command or `ended` ends it. `ready` is called once, with the path of
/// the port for the host.
///
/// # Errors
/// [`SimError`]
pub fn simulate(
    experiment: Experiment,
    options: &SimOptions,
    commands: &Receiver<Command>,
    ready: impl FnOnce(&Path),
    ended: &dyn Fn() -> bool,
) -> Result<(), SimError> {
    let mut robot = Robot::new(experiment, options)?;
    ready(options.name.as_deref().unwrap_or(robot.pty.path()));
    while !ended() {
        match commands.try_recv() {
            Ok(Command::Quit) => break,
            Ok(command) => robot.execute(command)?,
            Err(TryRecvError::Empty | TryRecvError::Disconnected) => {}
        }
        robot.apply_faults()?;
        robot.step()?;
    }
    Ok(())
}

struct Robot {
    device: Option<Device<Plant>>,
    pty: Pty,
    name: Option<StableName>,
    into: (Noise, Nemesis),
    out: (Noise, Nemesis),
    dice: Dice,
    origin: Instant,
    speed: f64,
    resets: Schedule,
    unplugs: Schedule,
}

/// The schedule of a random event.
struct Schedule {
    mean: Option<Duration>,
    next: Option<Instant>,
}

impl Schedule {
    fn new(mean_s: Option<f64>, speed: f64, dice: &mut Dice) -> Self {
        let mean = mean_s.map(|s| Duration::from_secs_f64(s / speed));
        let mut schedule = Self { mean, next: None };
        schedule.draw(dice);
        schedule
    }

    fn draw(&mut self, dice: &mut Dice) {
        self.next = self.mean.map(|mean| {
            let wait = dice.wait(mean.as_secs_f64());
            Instant::now() + Duration::from_secs_f64(wait)
        });
    }

    /// Whether an event is due; if so, draws the time of the next.
    fn is_due(&mut self, dice: &mut Dice) -> bool {
        let due = self.next.is_some_and(|next| Instant::now() >= next);
        if due {
            self.draw(dice);
        }
        due
    }
}

/// The bytes that arrive over a line.
fn attacked((noise, nemesis): &mut (Noise, Nemesis), bytes: &[u8]) -> Vec<u8> {
    let (mut whole, mut arrived) = (Vec::new(), Vec::new());
    nemesis.pass(bytes, Instant::now(), &mut whole);
    noise.pass(&whole, &mut arrived);
    arrived
}

impl Robot {
    fn new(experiment: Experiment, options: &SimOptions) -> Result<Self, SimError> {
        let SimOptions {
            faults,
            speed,
            seed,
            ..
        } = *options;
        let memory =
            Memory::new(options.memory.clone(), speed).map_err(cannot("read the memory"))?;
        let truth =
            TruthFile::open(options.truth.as_deref()).map_err(cannot("open the truth file"))?;
        let plant = Plant::new(experiment, memory, truth, speed, faults.stuck, seed);
        let pty = Pty::open().map_err(cannot("open a pseudo-terminal"))?;
        let claimed = options
            .name
            .as_deref()
            .map(|path| StableName::claim(path).map_err(|_| SimError::NameTaken(path.to_owned())));
        let name = claimed.transpose()?;
        let mut dice = Dice::new(seed, 1);
        let robot = Self {
            device: Some(Device::boot(plant, 0_u32.wrapping_sub(WRAPS_AFTER_MS))),
            pty,
            name,
            into: (
                Noise::new(faults.noise, seed, 2),
                Nemesis::new(faults.hostile, 0.0, seed, 4),
            ),
            out: (
                Noise::new(faults.noise, seed, 3),
                Nemesis::new(faults.hostile, faults.forged, seed, 5),
            ),
            origin: Instant::now(),
            speed,
            resets: Schedule::new(faults.reset_every_s, speed, &mut dice),
            unplugs: Schedule::new(faults.unplug_every_s, speed, &mut dice),
            dice,
        };
        robot.update_link()?;
        Ok(robot)
    }

    fn update_link(&self) -> Result<(), SimError> {
        match &self.name {
            Some(name) => name
                .point_to(self.pty.path())
                .map_err(cannot("make the link to the pseudo-terminal")),
            None => Ok(()),
        }
    }

    /// Milliseconds, like a microcontroller's clock, which wraps after 49 days: here soon after the start.
    #[allow(clippy::cast_possible_truncation)]
    fn now_ms(&self) -> u32 {
        (self.origin.elapsed().as_millis() as u32).wrapping_sub(WRAPS_AFTER_MS)
    }

    fn device(&mut self) -> &mut Device<Plant> {
        self.device.as_mut().expect("only a reset takes the device")
    }

    fn execute(&mut self, command: Command) -> Result<(), SimError> {
        match command {
            Command::Reset => self.reset(),
            Command::Cut => self.device().hardware_mut().cut_next_record(),
            Command::Unplug(seconds) => self.unplug(seconds)?,
            Command::Stick => self.device().hardware_mut().stick(),
            Command::Press => self.device().hardware_mut().press(true),
            Command::Release => self.device().hardware_mut().press(false),
            Command::Erase => {
                self.device().hardware_mut().erase();
                self.reset();
            }
            Command::Swap => {
                self.device().hardware_mut().swap();
                self.reset();
            }
            Command::Quit => {}
        }
        Ok(())
    }

    /// Applies the random faults that are due.
    fn apply_faults(&mut self) -> Result<(), SimError> {
        if self.resets.is_due(&mut self.dice) {
            self.reset();
        }
        if self.unplugs.is_due(&mut self.dice) {
            self.unplug(UNPLUGGED_S)?;
        }
        Ok(())
    }

    fn reset(&mut self) {
        let now = self.now_ms();
        if let Some(device) = self.device.take() {
            let mut plant = device.into_hardware();
            plant.power_on();
            self.device = Some(Device::boot(plant, now));
        }
    }

    fn unplug(&mut self, seconds: f64) -> Result<(), SimError> {
        if let Some(name) = &self.name {
            name.remove();
        }
        // the host's end hangs up when the last descriptor of this end closes
        let next = Pty::open().map_err(cannot("open a pseudo-terminal"))?;
        drop(std::mem::replace(&mut self.pty, next));
        let powered = !self.dice.chance(POWERED_BY_CABLE);
        let back = Instant::now() + Duration::from_secs_f64(seconds / self.speed);
        while Instant::now() < back {
            thread::sleep(TICK.min(back - Instant::now()));
            if powered {
                let now = self.now_ms();
                self.device().tick(now);
            }
        }
        if !powered {
            self.reset();
        }
        self.update_link()
    }

    /// One step: receives bytes, ticks the device and sends replies.
    fn step(&mut self) -> Result<(), SimError> {
        let next = self.device().hardware().next_event();
        let wait = next.map_or(TICK, |at| at.saturating_duration_since(Instant::now()));
        let mut bytes = [0; 512];
        let count = self
            .pty
            .read(&mut bytes, wait.min(TICK))
            .map_err(cannot("read from the pseudo-terminal"))?;
        let arrived = attacked(&mut self.into, &bytes[..count]);
        let now = self.now_ms();
        self.device().tick(now);
        let mut replies = Vec::new();
        for byte in arrived {
            if let Some(reply) = self.device().receive(byte, now) {
                replies.extend_from_slice(reply);
            }
        }
        if self.device().hardware().is_cut() {
            self.reset();
            return Ok(());
        }
        let sent = attacked(&mut self.out, &replies);
        if !sent.is_empty() {
            self.pty
                .write(&sent)
                .map_err(cannot("write to the pseudo-terminal"))?;
        }
        match self.device().hardware_mut().take_failure() {
            Some(error) => Err(cannot("write the truth file")(error)),
            None => Ok(()),
        }
    }
}

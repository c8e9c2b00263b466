//! Motors, sensors and the coin.

use super::Dice;
use super::memory::{Memory, RECORD_BYTES};
use super::truth::{Truth, TruthFile};
use crate::{Experiment, Setting};
use coinmc_link::{Hardware, Info, Limits, Motion, Record, Sensors, capability};
use std::time::{Duration, Instant};

/// The simulated robot's description.
const INFO: Info = Info {
    uid: [0; 8],
    firmware: [2, 0, 0],
    capabilities: capability::LIGHT | capability::CARRIAGE,
    limits: Limits {
        spin_mrev_s: crate::MAX_SPIN_MREV_S,
        angle_cdeg: crate::MAX_ANGLE_CDEG,
        x_um: 500_000,
        y_um: 500_000,
    },
};

/// Greatest distance that the coin rolls, µm.
const MAX_ROLL_UM: f64 = 200_000.0;

/// The simulated robot's hardware.
#[derive(Debug)]
pub(super) struct Plant {
    experiment: Experiment,
    uid: [u8; 8],
    memory: Memory,
    truth: TruthFile,
    dice: Dice,
    speed: f64,
    /// Fraction of motions that never end.
    stuck: f64,
    /// The next motion never ends.
    stick_next: bool,
    /// When the present motion ends; `None`: nothing moves.
    busy: Option<Until>,
    /// The last setting of the spindle.
    aim: Setting,
    sensors: Sensors,
    /// Why the truth file could not be written, which makes the simulation worthless.
    failed: Option<std::io::Error>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Until {
    Then(Instant),
    /// Stuck.
    Never,
}

impl Plant {
    pub(super) fn new(
        experiment: Experiment,
        memory: Memory,
        truth: TruthFile,
        speed: f64,
        stuck: f64,
        seed: u64,
    ) -> Self {
        let mut plant = Self {
            experiment,
            uid: *b"coin-sim",
            memory,
            truth,
            dice: Dice::new(seed, 0),
            speed,
            stuck,
            stick_next: false,
            busy: None,
            aim: Setting::default(),
            sensors: Sensors::default(),
            failed: None,
        };
        plant.power_on();
        plant
    }

    /// Starts up, which takes some time and ends all motion.
    pub(super) fn power_on(&mut self) {
        self.memory.power_on();
        self.busy = Some(Until::Then(Instant::now() + self.duration(1.0)));
    }

    /// Presses or releases the emergency stop.
    pub(super) fn press(&mut self, pressed: bool) {
        self.sensors.stopped = pressed;
    }

    /// Erases the memory.
    pub(super) fn erase(&mut self) {
        self.memory.erase();
    }

    /// Becomes another robot: another number, an empty memory.
    pub(super) fn swap(&mut self) {
        self.memory.erase();
        self.uid[7] = self.uid[7].wrapping_add(1);
    }

    /// Lets a reset come while the next record is written, or just after it.
    pub(super) fn cut_next_record(&mut self) {
        let most = u64::from(RECORD_BYTES) + 1;
        // the remainder is small
        #[allow(clippy::cast_possible_truncation)]
        let bytes = (self.dice.word() % most) as u32;
        self.memory.cut_after(bytes);
    }

    /// Whether that reset has come.
    pub(super) fn is_cut(&self) -> bool {
        self.memory.is_cut()
    }

    /// Makes the next motion never end.
    pub(super) fn stick(&mut self) {
        self.stick_next = true;
    }

    /// Time of the next event, if there is one.
    pub(super) fn next_event(&self) -> Option<Instant> {
        match self.busy {
            Some(Until::Then(at)) => Some(at),
            _ => None,
        }
    }

    /// The error of the truth file, once.
    pub(super) fn take_failure(&mut self) -> Option<std::io::Error> {
        self.failed.take()
    }

    /// Wall time for about this many seconds of the robot's time.
    fn duration(&mut self, seconds: f64) -> Duration {
        let varied = seconds * (0.85 + 0.3 * self.dice.uniform());
        Duration::from_secs_f64(varied / self.speed)
    }

    /// Releases the coin. The id of the throw is the one last stored in memory.
    fn release(&mut self) {
        let throw_id = self.memory.load().map_or(0, |record| record.throw_id);
        let throw = throw_id.saturating_sub(1);
        // settings were checked when the simulation started, and throws fail for no other reason
        let face = self.experiment.model_face(throw, self.aim).ok().flatten();
        let truth = Truth {
            throw_id,
            spin_mrev_s: self.aim.spin_mrev_s(),
            angle_cdeg: self.aim.angle_cdeg(),
            face: face.map(|face| face.name().to_owned()),
        };
        if let Err(error) = self.truth.add(&truth) {
            self.failed = Some(error);
        }
    }

    /// A measurement: the true value plus noise.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    fn measured(&mut self, value: u16, spread: f64) -> u16 {
        let error = libm::round((self.dice.uniform() - 0.5) * 2.0 * spread);
        // the cast saturates at 0
        (f64::from(value) + error) as u16
    }

    #[allow(clippy::cast_possible_truncation)]
    fn somewhere(&mut self) -> i32 {
        ((self.dice.uniform() - 0.5) * 2.0 * MAX_ROLL_UM) as i32
    }
}

impl Hardware for Plant {
    fn info(&self) -> Info {
        Info {
            uid: self.uid,
            ..INFO
        }
    }

    fn load(&mut self) -> Option<Record> {
        self.memory.load()
    }

    fn store(&mut self, record: &Record) -> bool {
        self.memory.store(*record)
    }

    fn start(&mut self, motion: Motion) {
        if self.memory.is_cut() {
            return;
        }
        let seconds = match motion {
            Motion::Aim { .. } => 1.5,
            Motion::Release => 1.3,
            Motion::DriveToCoin => 2.0,
            Motion::Return | Motion::Home { .. } => 3.2,
            Motion::MoveCarriage { .. } => 1.0,
        };
        let stuck = std::mem::take(&mut self.stick_next) || self.dice.chance(self.stuck);
        let until = Instant::now() + self.duration(seconds);
        self.busy = Some(if stuck {
            Until::Never
        } else {
            Until::Then(until)
        });
        match motion {
            Motion::Aim {
                spin_mrev_s,
                angle_cdeg,
            } => {
                // the link accepts nothing else
                self.aim = Setting::new(spin_mrev_s, angle_cdeg).unwrap_or_default();
                self.sensors.spin_mrev_s = self.measured(spin_mrev_s, 3.0);
                self.sensors.angle_cdeg = self.measured(angle_cdeg, 5.0);
            }
            // Even if the motion is stuck, the clamp is open and the coin falls.
            Motion::Release => self.release(),
            Motion::DriveToCoin => {
                (self.sensors.x_um, self.sensors.y_um) = (self.somewhere(), self.somewhere());
            }
            Motion::Return | Motion::Home { .. } => {
                (self.sensors.x_um, self.sensors.y_um) = (0, 0);
            }
            Motion::MoveCarriage { x_um, y_um } => {
                (self.sensors.x_um, self.sensors.y_um) = (x_um, y_um);
            }
        }
    }

    fn motors_off(&mut self) {
        self.busy = None;
    }

    fn light(&mut self, _: u16) {}

    fn sense(&mut self) -> Sensors {
        if let Some(Until::Then(at)) = self.busy
            && Instant::now() >= at
        {
            self.busy = None;
        }
        Sensors {
            settled: self.busy.is_none(),
            ..self.sensors
        }
    }
}

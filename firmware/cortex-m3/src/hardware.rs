//! REPLACE THIS FILE for a real robot. Instead of driving motors and sensors, this stand-in only takes
//! time, and less than a robot would; the pins that enable the motors and read the emergency stop are
//! real. The contract is that of [`Hardware`].

use crate::clock::Clock;
use crate::journal::{self, Journal};
use crate::pins;
use coinmc_link::{Hardware, Info, Limits, Motion, Record, Sensors, capability};

/// The stand-in.
pub struct Robot {
    clock: Clock,
    journal: Journal,
    /// The last motion and when it will be complete; none while the motors are off.
    moving: Option<(Motion, u32)>,
    aim: (u16, u16),
    x_um: i32,
    y_um: i32,
}

impl Robot {
    /// A robot at rest.
    pub fn new(clock: Clock) -> Self {
        Self {
            clock,
            journal: journal::open(),
            moving: None,
            aim: (0, 0),
            x_um: 0,
            y_um: 0,
        }
    }

    fn arrive(&mut self, motion: Motion, now_ms: u32) {
        (self.x_um, self.y_um) = match motion {
            Motion::MoveCarriage { x_um, y_um } => (x_um, y_um),
            Motion::DriveToCoin => {
                // the coin has come to rest somewhere
                let [x, y, ..] = now_ms.to_le_bytes();
                (i32::from(x) * 1000, i32::from(y) * 1000)
            }
            Motion::Return | Motion::Home { .. } => (0, 0),
            Motion::Aim { .. } | Motion::Release => (self.x_um, self.y_um),
        };
    }
}

/// Duration of a motion, ms.
fn duration_ms(motion: Motion) -> u32 {
    match motion {
        Motion::Aim { .. } => 80,
        Motion::Release => 120,
        Motion::DriveToCoin => 130,
        Motion::Return => 150,
        Motion::Home { .. } => 200,
        Motion::MoveCarriage { .. } => 50,
    }
}

impl Hardware for Robot {
    fn info(&self) -> Info {
        Info {
            uid: *b"lm3s69-1",
            firmware: [0, 2, 0],
            capabilities: capability::LIGHT | capability::CARRIAGE,
            limits: Limits {
                spin_mrev_s: 5000,
                angle_cdeg: 18_000,
                x_um: 400_000,
                y_um: 300_000,
            },
        }
    }

    fn load(&mut self) -> Option<Record> {
        journal::load(&self.journal)
    }

    fn store(&mut self, record: &Record) -> bool {
        self.journal.store(record)
    }

    fn start(&mut self, motion: Motion) {
        if let Motion::Aim {
            spin_mrev_s,
            angle_cdeg,
        } = motion
        {
            self.aim = (spin_mrev_s, angle_cdeg);
        }
        let done_ms = self.clock.now_ms().wrapping_add(duration_ms(motion));
        self.moving = Some((motion, done_ms));
        // stays on until switched off: motors hold their place
        pins::enable_motors(true);
    }

    fn motors_off(&mut self) {
        pins::enable_motors(false);
        self.moving = None;
    }

    fn light(&mut self, _: u16) {
        // the board has a lamp, but it does not dim
    }

    fn sense(&mut self) -> Sensors {
        let (now_ms, stuck) = (self.clock.now_ms(), pins::is_stuck());
        if let Some((motion, done_ms)) = self.moving
            && now_ms.wrapping_sub(done_ms) < u32::MAX / 2
            && !stuck
        {
            self.moving = None;
            self.arrive(motion, now_ms);
        }
        Sensors {
            settled: self.moving.is_none(),
            spin_mrev_s: self.aim.0,
            angle_cdeg: self.aim.1,
            x_um: self.x_um,
            y_um: self.y_um,
            failure: 0,
            stopped: pins::is_stopped(),
        }
    }
}

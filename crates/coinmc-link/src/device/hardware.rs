//! What a robot is made of, as the state machine sees it.

use crate::message::{Info, State};

/// Motors, sensors and a few bytes that survive a loss of power.
///
/// Nothing here may wait, except that [`Hardware::store`] returns only when the record is safe (well
/// below the 150 ms that the host waits for a reply).
pub trait Hardware {
    /// What the robot is and can reach.
    fn info(&self) -> Info;

    /// The newest record that was stored whole, if any was ever.
    fn load(&mut self) -> Option<Record>;

    /// Stores a record so that it survives a loss of power the moment this returns. Whether that
    /// succeeded. A record cut short by a loss of power must leave the one before it readable.
    fn store(&mut self, record: &Record) -> bool;

    /// Begins a motion; it replaces the one under way.
    fn start(&mut self, motion: Motion);

    /// No current in any motor, now. Called again and again while it must stay so.
    fn motors_off(&mut self);

    /// The lamp: 0 to 1000.
    fn light(&mut self, permille: u16);

    /// What the sensors say now.
    fn sense(&mut self) -> Sensors;
}

/// A motion of the robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Motion {
    /// Bring the coin to this spin and angle; settled when it may be released.
    Aim {
        /// Spin, 1/1000 rev/s.
        spin_mrev_s: u16,
        /// Angle at release, 1/100 degree.
        angle_cdeg: u16,
    },
    /// Let go of the coin; settled when it lies still.
    Release,
    /// Drive the carriage over the coin.
    DriveToCoin,
    /// Lift the coin and carry it back.
    Return,
    /// Find the end stops of these axes.
    Home {
        /// Bits of [`axis`](crate::axis).
        axes: u8,
    },
    /// Move the carriage.
    MoveCarriage {
        /// Along x from home, µm.
        x_um: i32,
        /// Along y from home, µm.
        y_um: i32,
    },
}

/// What the sensors say.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Sensors {
    /// The motion begun last has reached its goal; at the start: the robot is ready. From
    /// [`Hardware::start`] on it must be false until that is so.
    pub settled: bool,
    /// Spin of the coin, 1/1000 rev/s.
    pub spin_mrev_s: u16,
    /// Angle of the coin, 1/100 degree.
    pub angle_cdeg: u16,
    /// Carriage along x from home, µm.
    pub x_um: i32,
    /// Carriage along y from home, µm.
    pub y_um: i32,
    /// Something is broken: a number of the firmware's own (0: nothing), shown as fault
    /// [`fault::HARDWARE`](crate::fault::HARDWARE) plus it.
    pub failure: u8,
}

/// What outlives a reset.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Record {
    /// The last throw accepted.
    pub throw_id: u32,
    /// Starts counted so far; wraps.
    pub boot: u16,
    /// Idle, or the phase of the throw that was under way.
    pub phase: State,
}

//! The interface between the state machine and a robot's hardware.

use crate::message::{Info, State};

/// Motors, sensors and a few bytes of memory that survive a loss of power.
///
/// No method may block, except that [`Hardware::store`] returns only when the record is safe (well
/// within the 150 ms that the host waits for a reply).
pub trait Hardware {
    /// Description of the robot and its limits.
    fn info(&self) -> Info;

    /// The newest completely stored record, if there is one.
    fn load(&mut self) -> Option<Record>;

    /// Stores a record so that it survives a loss of power once this returns; whether that
    /// succeeded. If a loss of power interrupts it, the previous record must stay readable.
    fn store(&mut self, record: &Record) -> bool;

    /// Begins a motion, which replaces the present one.
    fn start(&mut self, motion: Motion);

    /// Switches off the current of all motors and ends the motion. Called repeatedly while they must
    /// stay off.
    fn motors_off(&mut self);

    /// Sets the lamp: 0 to 1000.
    fn light(&mut self, permille: u16);

    /// Reads the sensors.
    fn sense(&mut self) -> Sensors;
}

/// A motion of the robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Motion {
    /// Bring the coin to this spin and angle; settled when it can be released.
    Aim {
        /// Spin, 1/1000 rev/s.
        spin_mrev_s: u16,
        /// Angle at release, 1/100 degree.
        angle_cdeg: u16,
    },
    /// Release the coin; settled when it lies still.
    Release,
    /// Drive the carriage above the coin.
    DriveToCoin,
    /// Lift the coin and carry it back.
    Return,
    /// Move these axes to their end stops.
    Home {
        /// Bits of [`axis`](crate::axis).
        axes: u8,
    },
    /// Move the carriage.
    MoveCarriage {
        /// x coordinate from home, µm.
        x_um: i32,
        /// y coordinate from home, µm.
        y_um: i32,
    },
}

/// Readings of the sensors.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Sensors {
    /// The last motion has reached its goal; before the first motion: the robot is ready. False
    /// from [`Hardware::start`] until the goal is reached.
    pub settled: bool,
    /// Spin of the coin, 1/1000 rev/s.
    pub spin_mrev_s: u16,
    /// Angle of the coin, 1/100 degree.
    pub angle_cdeg: u16,
    /// x coordinate of the carriage from home, µm.
    pub x_um: i32,
    /// y coordinate of the carriage from home, µm.
    pub y_um: i32,
    /// The firmware's own number of a hardware failure (0: none); it is added to
    /// [`fault::HARDWARE`](crate::fault::HARDWARE) to give the fault code.
    pub failure: u8,
    /// The emergency stop is pressed (its circuit is open).
    pub stopped: bool,
}

/// A journal record, which survives a reset.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Record {
    /// The last throw accepted.
    pub throw_id: u32,
    /// The experiment that it belongs to; 0 for none.
    pub experiment: u32,
    /// Starts counted so far; wraps.
    pub boot: u16,
    /// Idle, the phase of the unfinished throw, or Fault after an emergency stop.
    pub phase: State,
}

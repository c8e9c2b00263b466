#![doc = include_str!("../README.md")]
//!
//! # How the parts fit together
//! ```text
//! config ─▶ Experiment ─settings─▶ Cycle ◀──▶ Journal ─▶ export, fairness
//!                                   │  ▲
//!                          port ◀───┘  └── camera        (run_session drives them)
//!                           │
//!                    robot, or sim
//! ```
//!
//! * An [`Experiment`] is the plan of a run, read as orders to a robot: throw k is fixed by the
//!   seed and k.
//! * The [`journal`] is the one truth: each entry on the disk before the step that follows from it.
//! * [`cycle`] decides the next step from the journal, the robot's last word and the camera's; it
//!   has no memory of its own that a crash could take.
//! * [`port`] is a serial port with the link's state machine on it, through any loss of the line.
//! * [`camera`] is any program that speaks a few lines of JSON.
//! * [`sim`] is a robot where there is none.
//! * [`export`] and [`fairness`] read the journal.

pub mod camera;
mod clock;
pub mod cycle;
mod directory;
mod experiment;
pub mod export;
pub mod fairness;
pub mod journal;
mod lock;
pub mod port;
mod recording;
mod session;
mod setting;
pub mod sim;

pub use clock::{Clock, unix_ms};
pub use coinmc_core::Face;
pub use directory::{Directory, DirectoryError, Setup};
pub use experiment::{Experiment, MAX_THROWS, NoExperiment};
pub use session::{
    Live, POLL, ProgressSink, RoundTrips, SessionError, SessionOptions, SessionReport, fault, name,
    run_session,
};
pub use setting::{MAX_ANGLE_CDEG, MAX_SPIN_MREV_S, Setting, SettingError};

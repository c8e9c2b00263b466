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
//! * An [`Experiment`] is the plan of a run, interpreted as commands to a robot: throw k depends
//!   only on the seed and k.
//! * The [`journal`] is the single source of truth: each entry is on disk before the step that
//!   follows from it.
//! * [`cycle`] decides the next step from the journal and the latest messages of robot and camera;
//!   it has no state of its own that a crash could lose.
//! * [`port`] is a serial port that runs the link's state machine and reconnects after any loss.
//! * [`camera`] is any program that speaks a few lines of JSON.
//! * [`sim`] is a simulated robot.
//! * [`export`] and [`fairness`] read the journal.

pub mod camera;
mod clock;
pub mod cycle;
mod directory;
mod experiment;
pub mod export;
pub mod fairness;
mod files;
pub mod journal;
mod liveness;
mod lock;
pub mod port;
mod recording;
mod reporter;
mod session;
mod setting;
pub mod sim;
mod words;

pub use clock::{Clock, unix_ms};
pub use coinmc_core::Face;
pub use directory::{Directory, DirectoryError, Setup};
pub use experiment::{Experiment, MAX_THROWS, UnsuitablePlan};
pub use files::{free_bytes, make_folder, replace_file};
pub use reporter::{Progress, ProgressSink, RoundTrips};
pub use session::{POLL, SessionError, SessionOptions, SessionReport, run_session};
pub use setting::{MAX_ANGLE_CDEG, MAX_SPIN_MREV_S, Setting, SettingError};
pub use words::{fault_text, state_name};

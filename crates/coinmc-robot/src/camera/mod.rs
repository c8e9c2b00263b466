//! Photos, taken by any program that speaks a few lines of JSON.
//!
//! The camera is a child process. It reads one request per line from its standard input and replies
//! to each with one line on its standard output:
//!
//! ```text
//! {"take": {"throw": 12, "attempt": 1, "request": 23, "folder": "/data/photos", "name": "000012-1"}}
//! {"throw": 12, "attempt": 1, "request": 23, "image": "000012-1.png"}
//! {"classify": "/data/photos/000012-1.png", "throw": 12, "attempt": 1, "request": 24}
//! {"throw": 12, "attempt": 1, "request": 24, "face": "heads"}
//! ```
//!
//! A reply counts only if it belongs to its request: it repeats throw and attempt, names the file that
//! was asked for, the file is a picture that was never seen before, and nothing else was said.
//!
//! docs/guide/robot.md has the rules. A child that hangs, ends or replies anything else is ended
//! and started again, and the photo counts as failed.

mod child;
mod log;
mod picture;
mod protocol;
mod roll;
mod simulated;
mod worker;

pub use child::CameraError;
pub use protocol::{Classify, LONGEST_LINE, Request, Take};
pub use simulated::{CameraFaults, simulate_camera};
pub use worker::{Camera, CameraFailure, CameraOptions, PhotoResult};

//! Photos, taken by any program that speaks a few lines of JSON.
//!
//! The camera is a child process. It reads one request per line from its standard input and replies
//! to each with one line on its standard output:
//!
//! ```text
//! {"take": {"throw": 12, "attempt": 1, "folder": "/data/photos", "name": "000012-1"}}
//! {"image": "000012-1.png"}
//! {"classify": "/data/photos/000012-1.png"}
//! {"face": "heads"}
//! ```
//!
//! docs/guide/robot.md has the rules. A child that hangs, ends or replies anything else is ended
//! and started again, and the photo counts as failed.

mod child;
mod picture;
mod protocol;
mod simulated;
mod worker;

pub use child::CameraError;
pub use protocol::{LONGEST_LINE, Request, Take};
pub use simulated::{CameraFaults, simulate_camera};
pub use worker::{Camera, CameraOptions, PhotoResult};

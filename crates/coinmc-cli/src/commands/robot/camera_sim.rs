//! `coinmc robot camera-sim`: the camera of the simulated robot.

use super::sim::share;
use crate::exit::{Failure, Outcome};
use clap::Args;
use coinmc_robot::camera::{CameraFaults, simulate_camera};
use std::io;
use std::path::PathBuf;

/// Be the camera of a simulated robot: JSON lines on standard input and output
///
/// For `--camera` of `coinmc robot run`. It photographs what the simulated robot's side file says,
/// and can be told to fail.
#[derive(Debug, Args)]
pub(super) struct CameraSim {
    /// The side file that `coinmc robot sim --truth` writes
    #[arg(long, value_name = "FILE")]
    truth: PathBuf,

    /// Share of photos in which another face is read
    #[arg(long, value_name = "SHARE", default_value_t = 0.0, value_parser = share)]
    misread: f64,

    /// Share of photos in which no face is read
    #[arg(long, value_name = "SHARE", default_value_t = 0.0, value_parser = share)]
    unread: f64,

    /// Share of photos at which the program hangs
    #[arg(long, value_name = "SHARE", default_value_t = 0.0, value_parser = share)]
    hang: f64,

    /// Share of photos at which the program ends
    #[arg(long, value_name = "SHARE", default_value_t = 0.0, value_parser = share)]
    die: f64,

    /// Key of all chance
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

impl CameraSim {
    pub(super) fn execute(&self) -> Result<Outcome, Failure> {
        let faults = CameraFaults {
            misread: self.misread,
            unread: self.unread,
            hang: self.hang,
            die: self.die,
        };
        let (input, output) = (io::stdin().lock(), io::stdout().lock());
        match simulate_camera(&self.truth, &faults, self.seed, input, output) {
            // the host has gone
            Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(Outcome::Done),
            Err(error) => Err(Failure::Runtime(error.into())),
            Ok(()) => Ok(Outcome::Done),
        }
    }
}

//! `coinmc robot camera-sim`: the camera of the simulated robot.

use super::sim::fraction;
use crate::exit::{Failure, Outcome};
use clap::Args;
use coinmc_robot::camera::{CameraFaults, simulate_camera};
use std::io;
use std::path::PathBuf;

/// Simulate the camera of a simulated robot: JSON lines on standard input and output
///
/// For `--camera` of `coinmc robot run`. It photographs the coin described in the simulated robot's
/// truth file, with random faults on demand.
#[derive(Debug, Args)]
pub(super) struct CameraSim {
    /// The truth file that `coinmc robot sim --truth` writes
    #[arg(long, value_name = "FILE")]
    truth: PathBuf,

    /// Fraction of photos in which a wrong face is read
    #[arg(long, value_name = "FRACTION", default_value_t = 0.0, value_parser = fraction)]
    misread: f64,

    /// Fraction of photos in which no face is read
    #[arg(long, value_name = "FRACTION", default_value_t = 0.0, value_parser = fraction)]
    unread: f64,

    /// Fraction of photos at which the program hangs
    #[arg(long, value_name = "FRACTION", default_value_t = 0.0, value_parser = fraction)]
    hang: f64,

    /// Fraction of photos at which the program ends
    #[arg(long, value_name = "FRACTION", default_value_t = 0.0, value_parser = fraction)]
    die: f64,

    /// Fraction of answers with something that a camera must not do: an old picture or frame, a
    /// second line, an answer about another throw, another file name
    #[arg(long, value_name = "FRACTION", default_value_t = 0.0, value_parser = fraction)]
    vice: f64,

    /// Seed of all random numbers
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
            vice: self.vice,
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

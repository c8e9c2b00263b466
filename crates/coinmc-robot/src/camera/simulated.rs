//! The camera of the simulated robot, which reads the coin's face from the robot's truth file.

use super::picture::{picture, shown};
use super::protocol::{LONGEST_LINE, Request, Take};
use crate::Face;
use crate::sim::{Dice, last_truth};
use serde_json::{Value, json};
use std::fs::{self, File};
use std::io::{self, BufRead, Read, Write};
use std::path::Path;

/// Random faults of the camera.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CameraFaults {
    /// Fraction of photos in which a wrong face is read.
    pub misread: f64,
    /// Fraction of photos in which no face is read.
    pub unread: f64,
    /// Fraction of photos after which the program hangs.
    pub hang: f64,
    /// Fraction of photos after which the program ends.
    pub die: f64,
}

/// Replies to requests until they end. `truth` is the truth file of the simulated robot.
///
/// # Errors
/// Errors of the two streams.
pub fn simulate_camera(
    truth: &Path,
    faults: &CameraFaults,
    seed: u64,
    input: impl BufRead,
    mut output: impl Write,
) -> io::Result<()> {
    // A restarted camera must not repeat the same faults: it would fail forever.
    let mut dice = Dice::new(seed, u64::from(std::process::id()) + 16);
    let mut input = input;
    loop {
        let mut line = Vec::new();
        let read = input
            .by_ref()
            .take(LONGEST_LINE as u64)
            .read_until(b'\n', &mut line)?;
        if read == 0 {
            return Ok(());
        }
        let answer = match serde_json::from_slice(&line) {
            Ok(Request::Take(take)) => {
                if dice.chance(faults.die) {
                    return Ok(());
                }
                if dice.chance(faults.hang) {
                    hang();
                }
                self::take(truth, &take)
            }
            Ok(Request::Classify(path)) => classify(&path, faults, &mut dice),
            Err(error) => Err(io::Error::other(error)),
        };
        let answer = answer.unwrap_or_else(|error| json!({ "error": error.to_string() }));
        writeln!(output, "{answer}")?;
        output.flush()?;
    }
}

/// Waits until the process is killed.
fn hang() -> ! {
    loop {
        std::thread::park();
    }
}

fn take(truth: &Path, take: &Take) -> io::Result<Value> {
    let face = last_truth(truth)?.and_then(|truth| truth.face());
    let name = format!("{}.png", take.name);
    fs::write(take.folder.join(&name), picture(face))?;
    Ok(json!({ "image": name }))
}

fn classify(path: &Path, faults: &CameraFaults, dice: &mut Dice) -> io::Result<Value> {
    const MOST: u64 = 1 << 20;
    let mut bytes = Vec::new();
    File::open(path)?.take(MOST).read_to_end(&mut bytes)?;
    let mut face = shown(&bytes);
    if dice.chance(faults.misread) {
        face = face.map(another);
    }
    if dice.chance(faults.unread) {
        face = None;
    }
    Ok(json!({ "face": face.map_or("none", Face::name) }))
}

fn another(face: Face) -> Face {
    match face {
        Face::Heads => Face::Tails,
        Face::Tails => Face::Side,
        Face::Side => Face::Heads,
    }
}

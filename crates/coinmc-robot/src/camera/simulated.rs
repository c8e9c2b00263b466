//! The camera of the simulated robot: sees what its side file of truth says.

use super::picture::{picture, shown};
use super::protocol::{LONGEST_LINE, Request, Take};
use crate::Face;
use crate::sim::{Dice, last_truth};
use serde_json::{Value, json};
use std::fs::{self, File};
use std::io::{self, BufRead, Read, Write};
use std::path::Path;

/// What goes wrong with photos.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CameraFaults {
    /// Share of photos in which another face is read.
    pub misread: f64,
    /// Share of photos in which no face is read.
    pub unread: f64,
    /// Share of photos after which the program hangs.
    pub hang: f64,
    /// Share of photos after which the program ends.
    pub die: f64,
}

/// Answers requests until they end. `truth` is the side file of the simulated robot.
///
/// # Errors
/// Those of the two streams.
pub fn simulate_camera(
    truth: &Path,
    faults: &CameraFaults,
    seed: u64,
    input: impl BufRead,
    mut output: impl Write,
) -> io::Result<()> {
    // A camera that is started again must not do the same again: it would die for ever.
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

/// Until somebody ends the process.
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

//! The camera of the simulated robot, which reads the coin's face from the robot's truth file.

use super::picture::{picture, shown};
use super::protocol::{Classify, LONGEST_LINE, Request, Take};
use crate::Face;
use crate::clock::unix_ms;
use crate::files::open_to_read;
use crate::sim::{Dice, last_truth};
use serde_json::{Value, json};
use std::fs;
use std::io::{self, BufRead, Read, Write};
use std::path::{Path, PathBuf};

/// Age of a frame that lay in a buffer, however late the request for it is read.
const OLD_FRAME_MS: u64 = 60_000;

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
    /// Fraction of answers with something that a camera must not do: an old picture or frame, a second
    /// line, an answer about another throw, another file name.
    pub vice: f64,
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
            Ok(Request::Take { take }) => {
                if dice.chance(faults.die) {
                    return Ok(());
                }
                if dice.chance(faults.hang) {
                    hang();
                }
                self::take(truth, &take, &mut dice)
            }
            Ok(Request::Classify(photo)) => classify(&photo, faults, &mut dice),
            Err(error) => Err(io::Error::other(error)),
        };
        let mut answer = answer.unwrap_or_else(|error| json!({ "error": error.to_string() }));
        let mut extra = None;
        if dice.chance(faults.vice) {
            extra = misbehave(&mut answer, &line, &mut dice);
        }
        writeln!(output, "{answer}")?;
        if let Some(extra) = extra {
            writeln!(output, "{extra}")?;
        }
        output.flush()?;
    }
}

/// Spoils an answer in one of the ways that a host must notice; also returns a second line.
fn misbehave(answer: &mut Value, line: &[u8], dice: &mut Dice) -> Option<Value> {
    let face = Face::ALL[(dice.word() % 3) as usize].name();
    match dice.word() % 5 {
        0 => answer["throw"] = json!(answer["throw"].as_u64().unwrap_or(0).wrapping_sub(1)),
        1 => {
            // the picture before this one again
            let request: Option<Request> = serde_json::from_slice(line).ok();
            if let Some(Request::Take { take }) = request {
                let again = take.folder.join(answer["image"].as_str().unwrap_or(""));
                let older = newest_but(&take.folder, &again);
                if let Some(older) = older.and_then(|path| fs::read(path).ok()) {
                    let _ = fs::write(again, older);
                }
            }
        }
        2 => answer["image"] = json!("000001-1.png"),
        3 => {
            // a frame that lay in a buffer, of another coin
            let request: Option<Request> = serde_json::from_slice(line).ok();
            if let Some(Request::Take { take }) = request {
                let grain = format!("{:016x}", dice.word());
                let path = take.folder.join(format!("{}.png", take.name));
                let _ = fs::write(path, picture(Face::named(face), &grain));
                answer["taken_ms"] = json!(unix_ms().saturating_sub(OLD_FRAME_MS));
            }
        }
        _ => {
            let mut more = json!({ "face": face });
            for key in ["throw", "attempt", "request"] {
                more[key] = answer[key].clone();
            }
            return Some(more);
        }
    }
    None
}

fn newest_but(folder: &Path, but: &Path) -> Option<PathBuf> {
    let paths = fs::read_dir(folder).ok()?.flatten().map(|e| e.path());
    paths.filter(|path| path != but).max()
}

/// Waits until the process is killed.
fn hang() -> ! {
    loop {
        std::thread::park();
    }
}

fn take(truth: &Path, take: &Take, dice: &mut Dice) -> io::Result<Value> {
    let face = last_truth(truth)?.and_then(|truth| truth.face());
    let name = format!("{}.png", take.name);
    let grain = format!("{:016x}", dice.word());
    fs::write(take.folder.join(&name), picture(face, &grain))?;
    Ok(json!({
        "throw": take.throw_id,
        "attempt": take.attempt,
        "request": take.request,
        "image": name,
        "taken_ms": unix_ms(),
    }))
}

fn classify(photo: &Classify, faults: &CameraFaults, dice: &mut Dice) -> io::Result<Value> {
    const MOST: u64 = 1 << 20;
    let mut bytes = Vec::new();
    open_to_read(&photo.classify)?
        .take(MOST)
        .read_to_end(&mut bytes)?;
    let mut face = shown(&bytes);
    if dice.chance(faults.misread) {
        face = face.map(another);
    }
    if dice.chance(faults.unread) {
        face = None;
    }
    let face = face.map_or("none", Face::name);
    Ok(json!({
        "throw": photo.throw_id,
        "attempt": photo.attempt,
        "request": photo.request,
        "face": face,
    }))
}

fn another(face: Face) -> Face {
    match face {
        Face::Heads => Face::Tails,
        Face::Tails => Face::Side,
        Face::Side => Face::Heads,
    }
}

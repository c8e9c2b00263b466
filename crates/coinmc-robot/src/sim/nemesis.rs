//! A line that attacks whole frames: it drops, doubles, swaps, delays and cuts them, sends old ones
//! again, and sends ones of its own: of another session, with another sequence number, or answers to
//! the very request that is outstanding, but about another throw or experiment or of an earlier time.
//! (What it does not do is to tell a consistent lie about the open throw: the link has no secrets, and
//! whoever owns the cable owns the robot.)

use super::Dice;
use super::forgery::{reframed, with_another_identity, with_old_content};
use coinmc_link::{Header, Wire};
use std::time::{Duration, Instant};

/// Frames remembered, to be sent again.
const REMEMBERED: usize = 32;
/// Longest delay of a frame, ms.
const LONGEST_DELAY_MS: u64 = 400;
/// A piece that is longer than any frame is passed on as it is.
const LONGEST: usize = 200;

/// Attacks a fraction of the frames.
#[derive(Debug, Clone)]
pub struct Nemesis {
    share: f64,
    /// Of the answers, those that are preceded by a forged one.
    forged: f64,
    dice: Dice,
    /// The beginning of a frame.
    partial: Vec<u8>,
    seen: Vec<Vec<u8>>,
    held: Vec<(Instant, Vec<u8>)>,
}

impl Nemesis {
    /// Attacks on this fraction of frames, and forged answers before this fraction of answers, 0 to 1.
    pub fn new(share: f64, forged: f64, seed: u64, purpose: u64) -> Self {
        Self {
            share,
            forged,
            dice: Dice::new(seed, purpose),
            partial: Vec::new(),
            seen: Vec::new(),
            held: Vec::new(),
        }
    }

    /// Appends the bytes that arrive now: of these, and of those delayed before.
    pub fn pass(&mut self, bytes: &[u8], now: Instant, arrived: &mut Vec<u8>) {
        if self.share == 0.0 && self.forged == 0.0 {
            arrived.extend_from_slice(bytes);
            return;
        }
        let (due, later) = self.held.drain(..).partition(|(at, _)| *at <= now);
        self.held = later;
        let due: Vec<(Instant, Vec<u8>)> = due;
        for (_, frame) in due {
            arrived.extend(frame);
        }
        for &byte in bytes {
            self.partial.push(byte);
            let ended = byte == 0 && self.partial.len() > 1;
            if ended || self.partial.len() > LONGEST {
                let frame = std::mem::take(&mut self.partial);
                self.attack(frame, now, arrived);
            }
        }
    }

    fn attack(&mut self, mut frame: Vec<u8>, now: Instant, arrived: &mut Vec<u8>) {
        if self.seen.len() >= REMEMBERED {
            self.seen.remove(0);
        }
        self.seen.push(frame.clone());
        if self.dice.chance(self.forged) {
            arrived.extend(self.forged_answer(&frame));
        }
        if !self.dice.chance(self.share) {
            arrived.extend(frame);
            return;
        }
        match self.dice.word() % 8 {
            0 => {}
            1 => arrived.extend([&frame[..], &frame[..]].concat()),
            // behind the next frame, or much later
            2 => self.held.push((now, frame)),
            3 => {
                let delay = Duration::from_millis(self.dice.word() % LONGEST_DELAY_MS);
                self.held.push((now + delay, frame));
            }
            4 => {
                let left = self.below(frame.len());
                frame.truncate(left);
                arrived.extend(frame);
            }
            5 => {
                let old = self.below(self.seen.len());
                arrived.extend([&self.seen[old][..], &frame[..]].concat());
            }
            6 => arrived.extend([&self.stray()[..], &frame[..]].concat()),
            _ => {
                let other = reframed(&frame, &mut self.dice).unwrap_or_default();
                arrived.extend([&other[..], &frame[..]].concat());
            }
        }
    }

    /// An intact answer to the request that this frame answers, which arrives before it; nothing if the
    /// frame is no answer.
    fn forged_answer(&mut self, frame: &[u8]) -> Vec<u8> {
        let old = self.below(self.seen.len());
        let forged = if self.dice.chance(0.5) {
            with_another_identity(frame, &mut self.dice)
        } else {
            with_old_content(frame, &self.seen[old])
        };
        forged.unwrap_or_default()
    }

    /// An intact frame of a session that does not exist.
    fn stray(&mut self) -> Vec<u8> {
        let [a, b, c, d, ..] = self.dice.word().to_le_bytes();
        let header = Header {
            session: u16::from_le_bytes([a, b]),
            seq: u16::from_le_bytes([c, d]),
        };
        let length = self.below(9);
        let body = self.dice.word().to_le_bytes();
        Wire::new(header, &body[..length])
            .map_or_else(|_| Vec::new(), |wire| wire.as_bytes().to_vec())
    }

    #[allow(clippy::cast_possible_truncation)] // below `end`
    fn below(&mut self, end: usize) -> usize {
        (self.dice.word() % end.max(1) as u64) as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_attacked_and_some_arrive_whole() {
        let header = Header { session: 7, seq: 1 };
        let frame = Wire::new(header, &[1, 2, 3]).unwrap();
        let begun = Instant::now();
        let run = |share: f64| {
            let mut nemesis = Nemesis::new(share, 0.0, 3, 0);
            let mut arrived = Vec::new();
            for number in 0..500 {
                let now = begun + Duration::from_millis(10 * number);
                nemesis.pass(frame.as_bytes(), now, &mut arrived);
            }
            let whole = arrived.windows(frame.as_bytes().len());
            let whole = whole.filter(|bytes| *bytes == frame.as_bytes()).count();
            (arrived.len(), whole)
        };
        assert_eq!(run(0.0), (500 * frame.as_bytes().len(), 500));
        let (length, whole) = run(0.5);
        assert!(
            length != 500 * frame.as_bytes().len() && (300..700).contains(&whole),
            "{whole}"
        );
    }
}

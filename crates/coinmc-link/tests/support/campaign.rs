//! An experiment: a sequence of throws, each ending as done or void.

use super::Random;
use coinmc_link::{Request, State, Status};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    Done,
    Void,
}

/// The state that a host keeps on disk, and its next step.
#[derive(Debug, Default)]
pub struct Campaign {
    /// Ends of the throws, in order of their ids from 1.
    pub resolved: Vec<End>,
    /// The result of the pending throw has been saved.
    recorded: bool,
    /// The furthest phase of the pending throw seen so far.
    seen: usize,
}

impl Campaign {
    pub fn pending(&self) -> u32 {
        u32::try_from(self.resolved.len()).unwrap() + 1
    }

    pub fn count(&self, end: End) -> usize {
        self.resolved.iter().filter(|other| **other == end).count()
    }

    /// The next request, if the robot waits for one.
    pub fn next(&mut self, status: &Status) -> Option<Request> {
        let pending = self.pending();
        assert!(status.throw_id <= pending, "{status:?}");
        let at_it = status.throw_id == pending;
        if at_it {
            self.assert_goes_forward(status);
        }
        match status.state {
            State::Idle if at_it => {
                self.resolve();
                None
            }
            State::Idle => Some(Request::Throw {
                throw_id: pending,
                experiment: 1,
                spin_mrev_s: 3200,
                angle_cdeg: 9000,
            }),
            State::AtCoin if at_it => {
                self.recorded = true;
                Some(Request::Collect { throw_id: pending })
            }
            State::Fault => {
                if at_it {
                    self.resolve();
                }
                Some(Request::ClearFault { code: status.fault })
            }
            _ => None,
        }
    }

    fn resolve(&mut self) {
        let end = if self.recorded { End::Done } else { End::Void };
        self.resolved.push(end);
        self.recorded = false;
        self.seen = 0;
    }

    /// Fails if a throw seems to start again.
    fn assert_goes_forward(&mut self, status: &Status) {
        const ORDER: [State; 7] = [
            State::Aiming,
            State::Flying,
            State::Driving,
            State::AtCoin,
            State::Returning,
            State::Fault,
            State::Idle,
        ];
        // a robot that is starting has no phase
        if let Some(place) = ORDER.iter().position(|state| *state == status.state) {
            assert!(place >= self.seen, "went back: {status:?}");
            self.seen = place;
        }
    }
}

/// A line that flips, drops and inserts bytes.
#[derive(Debug)]
pub struct Noise {
    pub random: Random,
    /// Damaged bytes per thousand.
    pub per_mille: u32,
    /// Bytes damaged so far.
    pub damaged: u32,
}

impl Noise {
    /// The bytes that arrive.
    pub fn pass(&mut self, bytes: &[u8]) -> Vec<u8> {
        let mut arrived = Vec::new();
        for byte in bytes {
            if !self.random.chance(self.per_mille) {
                arrived.push(*byte);
                continue;
            }
            self.damaged += 1;
            match self.random.below(3) {
                0 => arrived.push(byte ^ (1 << self.random.below(8))),
                1 => {}
                _ => arrived.extend([*byte, self.random.byte()]),
            }
        }
        arrived
    }
}

//! Which robot and which program: the words of a session's entry.

use super::entry::{hex, number};
use coinmc_link::Info;
use std::fmt;

/// Longest version of a program.
const LONGEST: usize = 40;

/// A robot's unique number and the version of its firmware.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RobotName {
    /// Unique number.
    pub uid: u64,
    /// Version: major, minor, patch.
    pub firmware: [u8; 3],
}

impl RobotName {
    /// The words of a robot's description.
    pub fn of(info: &Info) -> Self {
        Self {
            uid: u64::from_be_bytes(info.uid),
            firmware: info.firmware,
        }
    }

    /// Parses exactly the format of [`Display`](fmt::Display).
    pub(super) fn read(uid: &str, firmware: &str) -> Option<Self> {
        let parts: Vec<&str> = firmware.split('.').collect();
        let [major, minor, patch] = *parts.as_slice() else {
            return None;
        };
        Some(Self {
            uid: hex(uid)?,
            firmware: [number(major)?, number(minor)?, number(patch)?],
        })
    }
}

impl fmt::Display for RobotName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [major, minor, patch] = self.firmware;
        write!(f, "{:016x} {major}.{minor}.{patch}", self.uid)
    }
}

/// A version of a program, if it is one word of harmless characters.
pub(super) fn program(text: &str) -> Option<String> {
    let plain = |c: char| c.is_ascii_alphanumeric() || ".+-".contains(c);
    let fits = (1..=LONGEST).contains(&text.len()) && text.chars().all(plain);
    fits.then(|| text.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_of_programs_are_single_words() {
        let longest = "1".repeat(LONGEST);
        for text in ["0.1.0", "1.0.0-rc.1+build", longest.as_str()] {
            assert_eq!(program(text), Some(text.to_owned()));
        }
        let too_long = "1".repeat(LONGEST + 1);
        for text in ["", "1 0", "1/0", "1\n", "é", too_long.as_str()] {
            assert_eq!(program(text), None, "{text:?}");
        }
    }
}

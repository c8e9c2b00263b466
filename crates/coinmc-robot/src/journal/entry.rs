//! What a line of the journal says.

use crate::{Face, Setting};
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// One entry. `at_ms` is the time of the host's clock, milliseconds since 1970.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Entry {
    /// The robot had counted to `counter` for somebody else; ids go on after it.
    Adopted {
        /// The robot's counter.
        counter: u32,
    },
    /// The robot is about to be told this throw.
    Announced {
        /// Number of the throw on the link.
        id: u32,
        /// What the robot is told.
        setting: Setting,
        /// When.
        at_ms: u64,
    },
    /// A photo showed how the coin lies, and the photo is on the disk.
    Read {
        /// Number of the throw.
        id: u32,
        /// What was read.
        reading: Reading,
        /// When.
        at_ms: u64,
    },
    /// The robot is ready again; the reading stands.
    Done {
        /// Number of the throw.
        id: u32,
    },
    /// The throw has no result.
    Void {
        /// Number of the throw.
        id: u32,
        /// Why.
        reason: VoidReason,
    },
}

/// The result of a throw.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Reading {
    /// How the coin lies.
    pub face: Face,
    /// Spin and start angle as the robot measured them.
    pub measured: Measured,
    /// The robot's boot number, which changes when it was reset.
    pub boot: u16,
    /// The photo.
    pub image: ImageName,
}

/// Spin and start angle at release, as the robot measured them: they may lie a little outside what
/// it can be told.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Measured {
    /// Thousandths of a turn a second.
    pub spin_mrev_s: u16,
    /// Hundredths of a degree.
    pub angle_cdeg: u16,
}

/// Why a throw has no result.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum VoidReason {
    /// No photo showed a face.
    Unread,
    /// The robot stopped with this fault: 100 + phase after a reset in mid-cycle.
    Fault(u16),
    /// The robot is ready and the coin was put away before a photo was read.
    Lost,
    /// The robot counts beyond this throw, and its counter was adopted.
    Superseded,
}

/// The name of a photo's file: letters, digits, `-`, `_` and `.`, at most 100, not beginning with
/// a dot. Such a name stays in its folder and in its line of the journal.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ImageName(String);

/// Not the name of a photo's file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("a photo's name has 1 to 100 letters, digits, `-`, `_` and `.`, and begins with no dot")]
pub struct ImageNameError;

impl ImageName {
    /// The name.
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl FromStr for ImageName {
    type Err = ImageNameError;

    fn from_str(name: &str) -> Result<Self, ImageNameError> {
        let plain = |c: char| c.is_ascii_alphanumeric() || "-_.".contains(c);
        let fits = (1..=100).contains(&name.len()) && name.chars().all(plain);
        if fits && !name.starts_with('.') {
            Ok(Self(name.to_owned()))
        } else {
            Err(ImageNameError)
        }
    }
}

impl fmt::Display for VoidReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unread => f.write_str("unread"),
            Self::Fault(code) => write!(f, "fault-{code}"),
            Self::Lost => f.write_str("lost"),
            Self::Superseded => f.write_str("superseded"),
        }
    }
}

impl FromStr for VoidReason {
    type Err = ();

    fn from_str(text: &str) -> Result<Self, ()> {
        Ok(match text {
            "unread" => Self::Unread,
            "lost" => Self::Lost,
            "superseded" => Self::Superseded,
            _ => Self::Fault(number(text.strip_prefix("fault-").ok_or(())?).ok_or(())?),
        })
    }
}

impl fmt::Display for Entry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Adopted { counter } => write!(f, "A {counter}"),
            Self::Announced { id, setting, at_ms } => write!(
                f,
                "I {id} {} {} {at_ms}",
                setting.spin_mrev_s(),
                setting.angle_cdeg()
            ),
            Self::Read { id, reading, at_ms } => write!(
                f,
                "R {id} {} {} {} {} {} {at_ms}",
                reading.face.name(),
                reading.measured.spin_mrev_s,
                reading.measured.angle_cdeg,
                reading.boot,
                reading.image.as_str(),
            ),
            Self::Done { id } => write!(f, "D {id}"),
            Self::Void { id, reason } => write!(f, "V {id} {reason}"),
        }
    }
}

impl Entry {
    /// The number of the throw that the entry is about; none for an adopted counter.
    pub fn id(&self) -> Option<u32> {
        match *self {
            Self::Adopted { .. } => None,
            Self::Announced { id, .. }
            | Self::Read { id, .. }
            | Self::Done { id }
            | Self::Void { id, .. } => Some(id),
        }
    }

    /// Reads what [`Display`](fmt::Display) writes, to the letter; `None` for anything else.
    pub fn read(text: &str) -> Option<Self> {
        let words: Vec<&str> = text.split(' ').collect();
        Some(match *words.as_slice() {
            ["A", counter] => Self::Adopted {
                counter: number(counter)?,
            },
            ["I", id, spin, angle, at] => Self::Announced {
                id: number(id)?,
                setting: setting(spin, angle)?,
                at_ms: number(at)?,
            },
            ["R", id, face, spin, angle, boot, image, at] => Self::Read {
                id: number(id)?,
                reading: Reading {
                    face: Face::ALL.into_iter().find(|f| f.name() == face)?,
                    measured: Measured {
                        spin_mrev_s: number(spin)?,
                        angle_cdeg: number(angle)?,
                    },
                    boot: number(boot)?,
                    image: image.parse().ok()?,
                },
                at_ms: number(at)?,
            },
            ["D", id] => Self::Done { id: number(id)? },
            ["V", id, reason] => Self::Void {
                id: number(id)?,
                reason: reason.parse().ok()?,
            },
            _ => return None,
        })
    }
}

fn setting(spin: &str, angle: &str) -> Option<Setting> {
    Setting::new(number(spin)?, number(angle)?).ok()
}

/// A decimal number written the one way: no sign, no leading zeros.
pub(super) fn number<T: FromStr>(text: &str) -> Option<T> {
    let plain = text.bytes().all(|byte| byte.is_ascii_digit());
    let shortest = text == "0" || !text.starts_with('0');
    (plain && shortest).then(|| text.parse().ok()).flatten()
}

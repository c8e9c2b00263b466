//! Entries of the journal.

use super::robot::{RobotName, program};
use crate::{Face, Setting};
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// One entry. `at_ms` is the time of the host's clock in milliseconds since 1970.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Entry {
    /// The robot is taken over as it is, with this counter: ids continue after it, or after the
    /// journal's last one if that is greater.
    Adopted {
        /// The robot's counter.
        counter: u32,
    },
    /// The robot and the program that make the throws after this.
    Session {
        /// The robot.
        robot: RobotName,
        /// Its boot number.
        boot: u16,
        /// Version of this program.
        program: String,
        /// Time.
        at_ms: u64,
    },
    /// A throw is about to be sent to the robot.
    Announced {
        /// Number of the throw on the link.
        id: u32,
        /// Setting of the throw.
        setting: Setting,
        /// Time.
        at_ms: u64,
    },
    /// A photo shows how the coin lies, and the photo is on disk.
    Read {
        /// Number of the throw.
        id: u32,
        /// The reading.
        reading: Reading,
        /// Time.
        at_ms: u64,
    },
    /// The robot is ready again, and the reading is final.
    Done {
        /// Number of the throw.
        id: u32,
    },
    /// The throw has no result.
    Void {
        /// Number of the throw.
        id: u32,
        /// The reason.
        reason: VoidReason,
    },
}

/// The result of a throw.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Reading {
    /// Face of the coin.
    pub face: Face,
    /// Spin and start angle measured by the robot.
    pub measured: Measured,
    /// The robot's boot number, which changes with every reset.
    pub boot: u16,
    /// The photo.
    pub image: ImageName,
    /// What tells this photo from any other; absent from journals of format 1.
    pub digest: Option<Digest>,
}

/// The first 64 bits of a photo's SHA-256.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Digest(pub u64);

/// Spin and start angle at release, measured by the robot: they may lie slightly outside the range
/// of settings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Measured {
    /// Spin, 1/1000 rev/s.
    pub spin_mrev_s: u16,
    /// Start angle, 1/100 degree.
    pub angle_cdeg: u16,
}

/// Why a throw has no result.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum VoidReason {
    /// No photo showed a face.
    Unread,
    /// The robot stopped with this fault: 100 + phase after a reset during the throw.
    Fault(u16),
    /// The robot is ready: the coin was collected before a photo was read.
    Lost,
    /// The robot's counter was ahead of this throw and was adopted.
    Superseded,
    /// Under this number the robot has made a throw that is not this one.
    Mismatch,
    /// The robot does not know whether it has made this throw: it is another one, or its memory was
    /// erased; and it was adopted.
    Foreign,
    /// Spin or angle at release were too far from those asked for.
    OffTarget,
}

/// File name of a photo: at most 100 letters, digits, `-`, `_` and `.`, not beginning with a dot.
/// Such a name cannot lead out of its folder or break its line of the journal.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ImageName(String);

/// Not a valid file name of a photo.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error(
    "a photo's name has 1 to 100 letters, digits, `-`, `_` and `.`, and does not begin with a dot"
)]
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
            Self::Mismatch => f.write_str("mismatch"),
            Self::Foreign => f.write_str("foreign"),
            Self::OffTarget => f.write_str("off-target"),
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
            "mismatch" => Self::Mismatch,
            "foreign" => Self::Foreign,
            "off-target" => Self::OffTarget,
            _ => Self::Fault(number(text.strip_prefix("fault-").ok_or(())?).ok_or(())?),
        })
    }
}

impl fmt::Display for Entry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Adopted { counter } => write!(f, "A {counter}"),
            Self::Session {
                robot,
                boot,
                program,
                at_ms,
            } => write!(f, "S {robot} {boot} {program} {at_ms}"),
            Self::Announced { id, setting, at_ms } => write!(
                f,
                "I {id} {} {} {at_ms}",
                setting.spin_mrev_s(),
                setting.angle_cdeg()
            ),
            Self::Read { id, reading, at_ms } => {
                write!(
                    f,
                    "R {id} {} {} {} {} {}",
                    reading.face.name(),
                    reading.measured.spin_mrev_s,
                    reading.measured.angle_cdeg,
                    reading.boot,
                    reading.image.as_str(),
                )?;
                if let Some(Digest(digest)) = reading.digest {
                    write!(f, " {digest:016x}")?;
                }
                write!(f, " {at_ms}")
            }
            Self::Done { id } => write!(f, "D {id}"),
            Self::Void { id, reason } => write!(f, "V {id} {reason}"),
        }
    }
}

impl Entry {
    /// Id of the entry's throw; none for an adopted counter or a session.
    pub fn id(&self) -> Option<u32> {
        match *self {
            Self::Adopted { .. } | Self::Session { .. } => None,
            Self::Announced { id, .. }
            | Self::Read { id, .. }
            | Self::Done { id }
            | Self::Void { id, .. } => Some(id),
        }
    }

    /// Parses exactly the format of [`Display`](fmt::Display); `None` for anything else.
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
            ["S", uid, firmware, boot, version, at] => Self::Session {
                robot: RobotName::read(uid, firmware)?,
                boot: number(boot)?,
                program: program(version)?,
                at_ms: number(at)?,
            },
            ["R", id, face, spin, angle, boot, image, at] => Self::Read {
                id: number(id)?,
                reading: reading([face, spin, angle, boot, image], None)?,
                at_ms: number(at)?,
            },
            ["R", id, face, spin, angle, boot, image, digest, at] => Self::Read {
                id: number(id)?,
                reading: reading([face, spin, angle, boot, image], Some(hex(digest)?))?,
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

fn reading(words: [&str; 5], digest: Option<u64>) -> Option<Reading> {
    let [face, spin, angle, boot, image] = words;
    Some(Reading {
        face: Face::ALL.into_iter().find(|f| f.name() == face)?,
        measured: Measured {
            spin_mrev_s: number(spin)?,
            angle_cdeg: number(angle)?,
        },
        boot: number(boot)?,
        image: image.parse().ok()?,
        digest: digest.map(Digest),
    })
}

fn setting(spin: &str, angle: &str) -> Option<Setting> {
    Setting::new(number(spin)?, number(angle)?).ok()
}

/// A decimal number in canonical form: no sign, no leading zeros.
pub(super) fn number<T: FromStr>(text: &str) -> Option<T> {
    let plain = text.bytes().all(|byte| byte.is_ascii_digit());
    let shortest = text == "0" || !text.starts_with('0');
    (plain && shortest).then(|| text.parse().ok()).flatten()
}

/// Sixteen hexadecimal digits, in canonical form.
pub(super) fn hex(text: &str) -> Option<u64> {
    let value = u64::from_str_radix(text, 16).ok()?;
    (format!("{value:016x}") == text).then_some(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn photos_have_plain_names() {
        let longest = "a".repeat(100);
        for name in ["1.jpg", "a-b_c.png", "-", longest.as_str()] {
            assert_eq!(
                name.parse::<ImageName>().map(|it| it.0),
                Ok(name.to_owned())
            );
        }
        let too_long = "a".repeat(101);
        for name in [
            "",
            ".jpg",
            "..",
            "a/b",
            "a b",
            "ä.jpg",
            "a\nb",
            too_long.as_str(),
        ] {
            assert_eq!(name.parse::<ImageName>(), Err(ImageNameError), "{name:?}");
        }
    }

    #[test]
    fn reasons_are_read_as_they_are_written() {
        for reason in [
            VoidReason::Unread,
            VoidReason::Fault(0),
            VoidReason::Fault(107),
            VoidReason::Lost,
            VoidReason::Superseded,
            VoidReason::Mismatch,
            VoidReason::Foreign,
            VoidReason::OffTarget,
        ] {
            assert_eq!(reason.to_string().parse(), Ok(reason));
        }
        for text in [
            "",
            "fault",
            "fault-",
            "fault-07",
            "fault--1",
            "fault-65536",
            "Lost",
        ] {
            assert_eq!(text.parse::<VoidReason>(), Err(()), "{text}");
        }
    }

    /// Entries of throws have their number, and only these.
    #[test]
    fn only_throws_have_a_number() {
        for (text, id) in [
            ("A 7", None),
            ("S 0000000000000001 1.2.3 4 0.1.0 5", None),
            ("I 7 2500 100 5", Some(7)),
            ("R 8 heads 2500 100 3 a.jpg 5", Some(8)),
            ("D 9", Some(9)),
            ("V 10 lost", Some(10)),
        ] {
            let entry = Entry::read(text).unwrap_or_else(|| panic!("{text}"));
            assert_eq!((entry.id(), entry.to_string().as_str()), (id, text));
        }
    }

    /// A number is written in one way, so that an entry is one text.
    #[test]
    fn numbers_are_canonical() {
        assert_eq!(
            [number("0"), number("10"), number("4294967295")],
            [Some(0), Some(10), Some(u32::MAX)]
        );
        for text in [
            "",
            "00",
            "01",
            "+1",
            "-1",
            "1.0",
            " 1",
            "a",
            "0a",
            "4294967296",
        ] {
            assert_eq!(number::<u32>(text), None, "{text}");
        }
        assert_eq!(number::<f64>("1e3"), None);
        assert_eq!(hex("00000000000000ff"), Some(255));
        for text in [
            "ff",
            "00000000000000FF",
            "+0000000000000ff",
            "000000000000000ff",
        ] {
            assert_eq!(hex(text), None, "{text}");
        }
    }
}

//! The journal: the one truth about an experiment, from which all else is derived.
//!
//! An append-only text, one entry a line, each line sealed by a CRC-32 that continues that of the
//! line before, each on the disk before the step that cannot be taken back:
//!
//! ```text
//! coinmc-robot-journal 1 <plan hash> <throws> <crc>
//! I 1 3204 9017 1795281733123 <crc>            announced, before the robot is told to throw
//! R 1 heads 3201 9011 4 000001-1.png 1795281741008 <crc>   read, before the coin is collected
//! D 1 <crc>                                    done, when the robot is ready again
//! I 2 …
//! V 2 fault-102 <crc>                          void, with the reason
//! ```
//!
//! Every announced throw ends as exactly one of done and void. docs/guide/robot.md describes every
//! field.

mod entry;
mod file;
mod history;
mod text;

pub use entry::{Entry, ImageName, ImageNameError, Measured, Reading, VoidReason};
pub use file::{Journal, JournalError};
pub use history::{History, Order, Pending, Resolution, Throw};
pub use text::{Damage, FORMAT, Header, Parsed, Seal, parse};

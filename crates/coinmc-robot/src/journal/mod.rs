//! The journal: the single source of truth of an experiment, from which everything else is derived.
//!
//! An append-only text with one entry per line. Each line ends with a CRC-32 that continues that of
//! the line before, and is on disk before the step that cannot be undone:
//!
//! ```text
//! coinmc-robot-journal 2 <plan hash> <throws> <experiment> <crc>
//! S 636f696e2d73696d 1.0.0 4 0.1.0 1795281733003 <crc>   robot, firmware, boot, program
//! I 1 3204 9017 1795281733123 <crc>            announced, before the throw is sent to the robot
//! R 1 heads 3201 9011 4 000001-1.png 5f2c… 1795281741008 <crc>   read, before the coin is collected
//! D 1 <crc>                                    done, once the robot is ready again
//! I 2 …
//! V 2 fault-102 <crc>                          void, with the reason
//! ```
//!
//! Every announced throw ends as either done or void. docs/guide/robot.md describes every field.

mod entry;
mod file;
mod history;
mod robot;
mod storage;
mod text;

pub use entry::{Digest, Entry, ImageName, ImageNameError, Measured, Reading, VoidReason};
pub use file::{Journal, JournalError};
pub use history::{History, OrderError, Pending, Resolution, Throw};
pub use robot::RobotName;
pub use storage::Storage;
pub use text::{Damage, FORMAT, Header, LineChecksum, Parsed, parse};

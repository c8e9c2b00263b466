//! Reading and writing the text that Tracker (Open Source Physics, Brown & Cox) exports.
//!
//! ```text
//! mass_A                       the track; or `#multi:` and a line of names, one per track
//! t       x       y       θ    names, optionally with units in brackets
//! 0.000   0.000   0.201   12.3 numbers; an empty cell is an unmarked point
//! ```
//! Cells are separated by tabs, semicolons, commas or spaces; the decimal mark is a point or a comma;
//! blank lines and lines with `#` are ignored. All problems of a file are reported at once, each with
//! its position. The formats are described in docs/guide/film.md.

mod choice;
mod diagnostics;
mod dialect;
mod encoding;
mod files;
mod header;
mod read;
mod write;

pub use choice::{AngleOf, Choice};
pub use diagnostics::{Diagnostics, Problem};
pub use dialect::{Delimiter, Dialect};
pub use encoding::Encoding;
pub use files::{bytes_of, given_before};
pub use header::Column;
pub use read::{Footage, MAX_BYTES, MAX_COLUMNS, MAX_LINE, read};
pub use write::write;

//! What Tracker (Open Source Physics, Brown & Cox) exports, read and written.
//!
//! ```text
//! mass_A                       the track; or `#multi:` and a line of names, one a track
//! t       x       y       θ    names, with units in brackets at most
//! 0.000   0.000   0.201   12.3 numbers; an empty cell is a point that was not marked
//! ```
//! Tabs, semicolons, commas or blanks between cells; decimals behind a point or a comma; lines with
//! `#` and blank lines mean nothing. All problems of a file are reported at once, each with its
//! place. The formats are described in docs/guide/film.md.

mod choice;
mod diagnostics;
mod dialect;
mod encoding;
mod header;
mod read;
mod write;

pub use choice::{AngleOf, Choice};
pub use diagnostics::{Diagnostics, Problem};
pub use dialect::{Delimiter, Dialect};
pub use encoding::Encoding;
pub use header::Column;
pub use read::{Footage, MAX_BYTES, MAX_COLUMNS, MAX_LINE, read};
pub use write::write;

//! Writing a drop like Tracker.

use super::choice::AngleOf;
use super::dialect::{Delimiter, Dialect};
use super::encoding::encoded;
use crate::drop::FilmedDrop;

/// Writes a drop in a dialect: one track of this name with the columns t, x, y in s and m, and θ in
/// degrees. An unmarked point is an empty cell (with spaces as delimiter: NaN).
///
/// Seconds and metres have `decimals` digits, and degrees two fewer; `None` writes all digits.
///
/// # Example
/// ```
/// use coinmc_film::text::{AngleOf, Dialect, write};
/// use coinmc_film::{FilmedDrop, Frame};
/// let drop = FilmedDrop {
///     name: String::new(),
///     frames: vec![Frame { time_s: 0.0, seen: [Some(0.0), None, Some(0.5)] }],
/// };
/// let bytes = write(&drop, "mass A", AngleOf::Tilt, &Dialect::default(), Some(3));
/// assert_eq!(bytes, "mass_A\nt\tx\ty\tθ\n0.000\t0.000\t\t28.6\n".as_bytes());
/// ```
pub fn write(
    drop: &FilmedDrop,
    track: &str,
    angle_of: AngleOf,
    dialect: &Dialect,
    decimals: Option<usize>,
) -> Vec<u8> {
    let delimiter = dialect.delimiter.character().to_string();
    let end = if dialect.crlf { "\r\n" } else { "\n" };
    let angle = if dialect.encoding == super::Encoding::Latin1 {
        "theta (°)"
    } else {
        "θ"
    };
    let angle = if dialect.delimiter == Delimiter::Blank {
        angle.replace(' ', "")
    } else {
        angle.to_owned()
    };
    let mut text = track.replace(' ', "_") + end;
    text += &["t", "x", "y", &angle].join(&delimiter);
    text += end;
    let number = |value: Option<f64>, fewer: usize| {
        let Some(value) = value else {
            let blank = dialect.delimiter == Delimiter::Blank;
            return if blank { "NaN" } else { "" }.to_owned();
        };
        let plain = match decimals {
            Some(decimals) => format!("{value:.*}", decimals.saturating_sub(fewer)),
            None => value.to_string(),
        };
        if dialect.decimal_comma && dialect.delimiter != Delimiter::Comma {
            plain.replace('.', ",")
        } else {
            plain
        }
    };
    for frame in &drop.frames {
        let [x, z, theta] = frame.seen;
        let marked = theta.map(|theta| angle_of.marked(theta).to_degrees());
        let cells = [
            number(Some(frame.time_s), 0),
            number(x, 0),
            number(z, 0),
            number(marked, 2),
        ];
        text += &cells.join(&delimiter);
        text += end;
    }
    encoded(&text, dialect.encoding)
}

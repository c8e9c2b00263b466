//! The journal as text: writing lines with checksums, parsing them, and distinguishing an
//! incomplete last line from damage.

use super::entry::number;
use super::{Entry, History, OrderError};
use thiserror::Error;

/// Version of the journal's format.
pub const FORMAT: u32 = 2;

/// First word of the first line.
const MAGIC: &str = "coinmc-robot-journal";

/// Longest line, including its end, bytes.
pub(super) const MAX_LINE: usize = 256;

/// The first line of a journal: the experiment that it belongs to.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Header {
    /// Hash of the plan.
    pub plan_hash: String,
    /// Throws planned.
    pub throws: u32,
    /// Number by which robots know the experiment, not 0: another one for every journal.
    pub experiment: u32,
}

impl Header {
    /// Whether two journals are of the same plan.
    pub fn is_same_plan(&self, other: &Self) -> bool {
        self.plan_hash == other.plan_hash && self.throws == other.throws
    }
}

/// The CRC-32 of all lines so far, which the next line continues: it reveals missing, repeated and
/// misplaced lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LineChecksum(u32);

impl LineChecksum {
    /// The line with this body and its checksum, and the checksum to continue from.
    #[must_use]
    pub fn line(self, body: &str) -> (String, Self) {
        let next = self.after(body.as_bytes());
        (format!("{body} {:08x}\n", next.0), next)
    }

    /// The first line of a journal.
    #[must_use]
    pub fn header(header: &Header) -> (String, Self) {
        let Header {
            plan_hash,
            throws,
            experiment,
        } = header;
        let body = format!("{MAGIC} {FORMAT} {plan_hash} {throws} {experiment}");
        Self::default().line(&body)
    }

    fn after(self, body: &[u8]) -> Self {
        let mut hasher = crc32fast::Hasher::new_with_initial(self.0);
        hasher.update(body);
        Self(hasher.finalize())
    }

    /// The body of a line (given without its end), if its checksum is correct.
    fn open(self, line: &str) -> Option<(&str, Self)> {
        let (body, crc) = line.rsplit_once(' ')?;
        let next = self.after(body.as_bytes());
        (crc == format!("{:08x}", next.0)).then_some((body, next))
    }
}

/// A parsed journal.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Parsed {
    /// The experiment that it belongs to.
    pub header: Header,
    /// The throws.
    pub history: History,
    /// The checksum that the next line continues.
    pub checksum: LineChecksum,
    /// Length of the complete lines, bytes.
    pub whole: usize,
    /// Bytes after them: a line whose writing was interrupted.
    pub torn: usize,
}

/// Why a journal cannot be continued.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum Damage {
    /// Not even the first line is complete: nothing was thrown yet.
    #[error("has no complete first line")]
    Empty,
    /// Another kind of file.
    #[error("is not a journal of a robot")]
    NotAJournal,
    /// Written by a newer program.
    #[error("has format {0}, but this program supports {FORMAT}: use the program that wrote it")]
    Newer(u32),
    /// A complete line has a wrong checksum or content.
    #[error("line {0} is damaged")]
    Line(usize),
    /// A line has a correct checksum but contradicts the lines before.
    #[error("line {line} contradicts the lines before: {order}")]
    Order {
        /// Number of the line, from 1.
        line: usize,
        /// The contradiction.
        order: OrderError,
    },
}

/// Parses a journal.
///
/// Only the last line may be damaged, if it has no end: its writing was interrupted. It is ignored,
/// and `torn` is its length.
///
/// # Errors
/// [`Damage`] for any other damage.
pub fn parse(bytes: &[u8]) -> Result<Parsed, Damage> {
    let mut lines = Lines { bytes, place: 0 };
    let (header, mut checksum) = match lines.next_line() {
        Some(line) => read_header(line)?,
        None if MAGIC
            .as_bytes()
            .starts_with(&bytes[..bytes.len().min(MAGIC.len())]) =>
        {
            return Err(Damage::Empty);
        }
        None => return Err(Damage::NotAJournal),
    };
    let mut history = History::default();
    let (mut whole, mut number) = (lines.place, 1);
    while let Some(line) = lines.next_line() {
        number += 1;
        let opened = std::str::from_utf8(line)
            .ok()
            .and_then(|l| checksum.open(l));
        let (body, next) = opened.ok_or(Damage::Line(number))?;
        let entry = Entry::read(body).ok_or(Damage::Line(number))?;
        history.add(&entry).map_err(|order| Damage::Order {
            line: number,
            order,
        })?;
        (checksum, whole) = (next, lines.place);
    }
    Ok(Parsed {
        header,
        history,
        checksum,
        whole,
        torn: bytes.len() - whole,
    })
}

fn read_header(line: &[u8]) -> Result<(Header, LineChecksum), Damage> {
    let line = std::str::from_utf8(line).map_err(|_| Damage::NotAJournal)?;
    let mut words = line.split(' ');
    if words.next() != Some(MAGIC) {
        return Err(Damage::NotAJournal);
    }
    let format: u32 = words.next().and_then(number).ok_or(Damage::Line(1))?;
    if format > FORMAT {
        return Err(Damage::Newer(format));
    }
    let (body, checksum) = LineChecksum::default().open(line).ok_or(Damage::Line(1))?;
    let words: Vec<&str> = body.split(' ').collect();
    let (plan_hash, throws, experiment) = match (format, &words[..]) {
        // its first line is as good a number as any
        (1, [_, _, plan_hash, throws]) => (plan_hash, throws, Some(checksum.0.max(1))),
        (2, [_, _, plan_hash, throws, experiment]) => (plan_hash, throws, number(experiment)),
        _ => return Err(Damage::Line(1)),
    };
    let header = Header {
        plan_hash: (*plan_hash).to_owned(),
        throws: number(throws).ok_or(Damage::Line(1))?,
        experiment: experiment
            .filter(|number| *number != 0)
            .ok_or(Damage::Line(1))?,
    };
    Ok((header, checksum))
}

/// Iterates over complete lines, without their ends.
struct Lines<'a> {
    bytes: &'a [u8],
    /// Offset of the next line.
    place: usize,
}

impl<'a> Lines<'a> {
    /// The next line; `None` at the end, or if the rest has no line end.
    fn next_line(&mut self) -> Option<&'a [u8]> {
        let rest = &self.bytes[self.place..];
        let end = rest.iter().position(|byte| *byte == b'\n')?;
        self.place += end + 1;
        // treat a line that is too long as empty: an empty line is never valid
        Some(if end < MAX_LINE { &rest[..end] } else { &[] })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file that begins like a journal was torn in its first line; any other is none.
    #[test]
    fn a_file_without_a_first_line_is_empty_or_none_of_ours() {
        let (line, _) = LineChecksum::header(&Header {
            plan_hash: "abc".to_owned(),
            throws: 3,
            experiment: 1,
        });
        for length in 0..line.len() {
            assert_eq!(
                parse(&line.as_bytes()[..length]),
                Err(Damage::Empty),
                "{length}"
            );
        }
        assert!(parse(line.as_bytes()).is_ok());
        for other in ["PNG", "coinmc-run", "x", "coinmc-robot-journey"] {
            assert_eq!(parse(other.as_bytes()), Err(Damage::NotAJournal), "{other}");
        }
    }

    /// The longest line has 256 bytes, its end included; what is longer is none.
    #[test]
    fn lines_end_at_their_greatest_length() {
        let line = |length: usize| [vec![b'a'; length], vec![b'\n']].concat();
        let first = |bytes: &[u8]| Lines { bytes, place: 0 }.next_line().map(<[u8]>::len);
        assert_eq!(first(&line(MAX_LINE - 1)), Some(MAX_LINE - 1));
        assert_eq!(first(&line(MAX_LINE)), Some(0));
        assert_eq!(first(b"no end"), None);
    }
}

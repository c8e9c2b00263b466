//! The journal as text: sealing lines, reading them back, telling a torn tail from damage.

use super::entry::number;
use super::{Entry, History, Order};
use thiserror::Error;

/// Version of the journal.
pub const FORMAT: u32 = 1;

/// First word of the first line.
const MAGIC: &str = "coinmc-robot-journal";

/// Longest line, its end included, bytes.
pub(super) const LONGEST: usize = 256;

/// What a journal belongs to.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Header {
    /// Hash of the plan.
    pub plan_hash: String,
    /// Throws planned.
    pub throws: u32,
}

/// The CRC-32 of all lines so far, which the next line continues: a line that is missing,
/// repeated or out of its place shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Seal(u32);

impl Seal {
    /// The line that says `body`, sealed, and the seal after it.
    #[must_use]
    pub fn line(self, body: &str) -> (String, Self) {
        let next = self.after(body.as_bytes());
        (format!("{body} {:08x}\n", next.0), next)
    }

    /// The first line of a journal.
    #[must_use]
    pub fn header(header: &Header) -> (String, Self) {
        let body = format!("{MAGIC} {FORMAT} {} {}", header.plan_hash, header.throws);
        Self::default().line(&body)
    }

    fn after(self, body: &[u8]) -> Self {
        let mut hasher = crc32fast::Hasher::new_with_initial(self.0);
        hasher.update(body);
        Self(hasher.finalize())
    }

    /// The body of a line without its end, if its seal is right.
    fn open(self, line: &str) -> Option<(&str, Self)> {
        let (body, crc) = line.rsplit_once(' ')?;
        let next = self.after(body.as_bytes());
        (crc == format!("{:08x}", next.0)).then_some((body, next))
    }
}

/// A journal read back.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Parsed {
    /// What it belongs to.
    pub header: Header,
    /// All that it says.
    pub history: History,
    /// What the next line continues.
    pub seal: Seal,
    /// Length of the lines that are whole, bytes.
    pub whole: usize,
    /// Bytes behind them: the line that was being written when the power went.
    pub torn: usize,
}

/// Why a journal cannot be gone on with.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum Damage {
    /// Not even the first line is whole: nothing was thrown yet.
    #[error("has no whole first line")]
    Empty,
    /// Another kind of file.
    #[error("is no journal of a robot")]
    NotAJournal,
    /// Written by a later program.
    #[error("has format {0}, this program knows {FORMAT}: use the program that wrote it")]
    Newer(u32),
    /// A line that has its end does not read back.
    #[error("line {0} is damaged")]
    Line(usize),
    /// A line is whole and says what cannot be.
    #[error("line {line} is whole and cannot be true: {order}")]
    Order {
        /// Number of the line, from 1.
        line: usize,
        /// What is wrong with it.
        order: Order,
    },
}

/// Reads a journal.
///
/// Only a last line without its end may be damaged: an append that was cut off. It is not believed,
/// and `torn` says how long it is.
///
/// # Errors
/// [`Damage`] for anything else that does not read back.
pub fn parse(bytes: &[u8]) -> Result<Parsed, Damage> {
    let mut lines = Lines { bytes, place: 0 };
    let (header, mut seal) = match lines.next_line() {
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
        let opened = std::str::from_utf8(line).ok().and_then(|l| seal.open(l));
        let (body, next) = opened.ok_or(Damage::Line(number))?;
        let entry = Entry::read(body).ok_or(Damage::Line(number))?;
        history.add(&entry).map_err(|order| Damage::Order {
            line: number,
            order,
        })?;
        (seal, whole) = (next, lines.place);
    }
    Ok(Parsed {
        header,
        history,
        seal,
        whole,
        torn: bytes.len() - whole,
    })
}

fn read_header(line: &[u8]) -> Result<(Header, Seal), Damage> {
    let line = std::str::from_utf8(line).map_err(|_| Damage::NotAJournal)?;
    let mut words = line.split(' ');
    if words.next() != Some(MAGIC) {
        return Err(Damage::NotAJournal);
    }
    let format: u32 = words.next().and_then(number).ok_or(Damage::Line(1))?;
    if format > FORMAT {
        return Err(Damage::Newer(format));
    }
    let (body, seal) = Seal::default().open(line).ok_or(Damage::Line(1))?;
    let words: Vec<&str> = body.split(' ').collect();
    let [_, _, plan_hash, throws] = words[..] else {
        return Err(Damage::Line(1));
    };
    let header = Header {
        plan_hash: plan_hash.to_owned(),
        throws: number(throws).ok_or(Damage::Line(1))?,
    };
    Ok((header, seal))
}

/// Whole lines, without their ends.
struct Lines<'a> {
    bytes: &'a [u8],
    /// Where the next line begins.
    place: usize,
}

impl<'a> Lines<'a> {
    /// The next line; `None` at the end, and for a rest that has no line's end.
    fn next_line(&mut self) -> Option<&'a [u8]> {
        let rest = &self.bytes[self.place..];
        let end = rest.iter().position(|byte| *byte == b'\n')?;
        self.place += end + 1;
        // what is too long for a line is none: nothing has the seal of nothing
        Some(if end < LONGEST { &rest[..end] } else { &[] })
    }
}

//! `provenance.jsonl`, line by line. See docs/reference/formats.md.

use super::effort::Effort;
use super::maker::Maker;
use crate::run::Chunk;
use serde::{Deserialize, Serialize};

/// The file in a run directory.
pub(crate) const FILE: &str = "provenance.jsonl";
/// Version of the format.
pub(crate) const FORMAT: u64 = 1;
/// Most chunks in a line.
pub(super) const MAX_CHUNKS: usize = 4096;
/// Longest line that is read, bytes: that many chunks with the longest numbers.
pub(super) const MAX_LINE: usize = 128 * MAX_CHUNKS;

/// A line.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Line {
    /// Says who a maker is, before its first chunks.
    Maker(Introduction),
    /// Chunks that a maker made.
    Chunks(Made),
}

#[derive(Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Introduction {
    pub(super) format: u64,
    pub(super) id: String,
    pub(super) maker: Maker,
}

#[derive(Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Made {
    pub(super) made_by: String,
    pub(super) chunks: Vec<Entry>,
}

/// A chunk and how long it took, as a list: point, first toss and the one after the last, microseconds by the
/// clock and of the processor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Entry(u32, u64, u64, u64, Option<u64>);

impl Entry {
    pub(crate) fn new(chunk: &Chunk, effort: Effort) -> Self {
        let point = u32::try_from(chunk.point).unwrap_or(u32::MAX);
        let Effort { wall_us, cpu_us } = effort;
        Self(point, chunk.tosses.start, chunk.tosses.end, wall_us, cpu_us)
    }

    /// Point and first toss.
    pub(super) fn key(&self) -> (u32, u64) {
        (self.0, self.1)
    }

    /// The toss after the last.
    pub(super) fn end(&self) -> u64 {
        self.2
    }

    pub(super) fn tosses(&self) -> u64 {
        self.2.saturating_sub(self.1)
    }

    pub(super) fn effort(&self) -> Effort {
        Effort {
            wall_us: self.3,
            cpu_us: self.4,
        }
    }
}

/// The lines of chunks of one maker.
pub(super) fn lines(id: &str, entries: &[Entry]) -> String {
    let lines = entries.chunks(MAX_CHUNKS).map(|chunks| {
        let made_by = id.to_owned();
        let chunks = chunks.to_vec();
        json(&Made { made_by, chunks })
    });
    lines.collect()
}

/// The line that says who a maker is.
pub(super) fn introduction(maker: &Maker) -> String {
    json(&Introduction {
        format: FORMAT,
        id: maker.id(),
        maker: maker.clone(),
    })
}

fn json(line: &impl Serialize) -> String {
    let mut text = serde_json::to_string(line).expect("plain fields are always JSON");
    text.push('\n');
    text
}

/// What a line says; `Err` with its format if that is newer; `None` if it cannot be read.
pub(super) fn read(line: &[u8]) -> Result<Option<Line>, u64> {
    #[derive(Deserialize)]
    struct AnyFormat {
        format: u64,
    }
    if line.starts_with(b"{\"made_by\"") {
        return Ok(serde_json::from_slice(line).ok().map(Line::Chunks));
    }
    match serde_json::from_slice(line) {
        Ok(AnyFormat { format }) if format > FORMAT => Err(format),
        Ok(_) => Ok(serde_json::from_slice(line).ok().map(Line::Maker)),
        Err(_) => Ok(None),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_line_is_read() {
        let chunk = Chunk {
            point: usize::MAX,
            tosses: u64::MAX - 1..u64::MAX,
        };
        let effort = Effort {
            wall_us: u64::MAX,
            cpu_us: Some(u64::MAX),
        };
        let entries = vec![Entry::new(&chunk, effort); MAX_CHUNKS + 1];
        let text = lines("0123456789abcdef", &entries);
        let lengths: Vec<_> = text.lines().map(str::len).collect();
        assert!(lengths.len() == 2 && lengths[0] < MAX_LINE, "{lengths:?}");
        let Ok(Some(Line::Chunks(made))) = read(text.lines().next().unwrap().as_bytes()) else {
            panic!("{text}");
        };
        assert_eq!(made.chunks, entries[1..]);
    }

    #[test]
    fn newer_formats_are_named_and_other_lines_skipped() {
        assert_eq!(read(b"{\"format\":2,\"id\":7}"), Err(2));
        for other in [
            &b""[..],
            b"{}",
            b"{\"format\":1}",
            b"{\"made_by\":\"a\",\"chunks\":[[1,2]]}",
            b"\xff",
        ] {
            assert_eq!(read(other), Ok(None));
        }
    }
}

//! Reads `provenance.jsonl`.

use super::maker::Maker;
use super::record::{self, Entry, FILE, FORMAT, Introduction, Line, MAX_LINE, Made};
use crate::run::replace::open_file;
use crate::run::{Chunk, RunError};
use std::collections::HashMap;
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

/// What a run directory tells of its chunks, found by point and first toss.
#[derive(Debug, Default)]
pub(crate) struct Records {
    makers: Vec<Maker>,
    /// Each chunk once, in order, with the index of its maker.
    entries: Vec<(Entry, u32)>,
}

impl Records {
    /// Reads the file of a directory; what is not there, or cannot be read as a line, tells nothing.
    pub(crate) fn read(dir: &Path) -> Result<Self, RunError> {
        let path = dir.join(FILE);
        let failed = |error| RunError::io("read", &path, error);
        let file = match open_file(&path) {
            Ok(file) => file,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Self::default()),
            Err(error) => return Err(failed(error)),
        };
        let (mut file, mut line) = (BufReader::new(file), Vec::new());
        let (mut records, mut known) = (Self::default(), HashMap::new());
        let mut places = HashMap::new();
        while next_line(&mut file, &mut line).map_err(failed)? {
            let found = record::read(&line).map_err(|format| RunError::NewerFormat {
                path: path.clone(),
                found: format,
                known: FORMAT,
            })?;
            match found {
                Some(Line::Maker(Introduction { id, maker, .. })) => {
                    let next = u32::try_from(places.len()).expect("a file has fewer lines");
                    known.insert(id, *places.entry(maker).or_insert(next));
                }
                Some(Line::Chunks(Made { made_by, chunks })) => {
                    if let Some(&maker) = known.get(&made_by) {
                        let chunks = chunks.into_iter().map(|entry| (entry, maker));
                        records.entries.extend(chunks);
                    }
                }
                None => {}
            }
        }
        let mut makers: Vec<_> = places.into_iter().collect();
        makers.sort_unstable_by_key(|(_, place)| *place);
        records.makers = makers.into_iter().map(|(maker, _)| maker).collect();
        records.keep_the_last_of_each();
        Ok(records)
    }

    /// A chunk that was made again, as its tally was lost, was made by the last that made it.
    fn keep_the_last_of_each(&mut self) {
        // stable
        self.entries.sort_by_key(|(entry, _)| entry.key());
        self.entries.reverse();
        self.entries.dedup_by_key(|(entry, _)| entry.key());
        self.entries.reverse();
        self.entries.shrink_to_fit();
    }

    pub(crate) fn makers(&self) -> &[Maker] {
        &self.makers
    }

    /// How a chunk was made: at once, or piece by piece by a run that another extends.
    pub(crate) fn of(&self, chunk: &Chunk) -> impl Iterator<Item = (&Entry, usize)> {
        let (point, end) = (chunk.point, chunk.tosses.end);
        let first = self.find(point, chunk.tosses.start);
        std::iter::successors(first, move |(entry, _)| {
            let next = entry.end();
            let goes_on = next < end && entry.tosses() > 0;
            goes_on.then(|| self.find(point, next)).flatten()
        })
    }

    /// How the chunk of a point that begins at toss `start` was made, and the index of its maker.
    pub(crate) fn find(&self, point: usize, start: u64) -> Option<(&Entry, usize)> {
        let key = (u32::try_from(point).ok()?, start);
        let place = self.entries.binary_search_by_key(&key, |(e, _)| e.key());
        let (entry, maker) = &self.entries[place.ok()?];
        Some((entry, *maker as usize))
    }
}

/// Reads the next line, without its line feed; one that is too long is left empty. False at the end.
fn next_line(file: &mut impl BufRead, line: &mut Vec<u8>) -> io::Result<bool> {
    line.clear();
    let most = MAX_LINE as u64;
    if file.take(most).read_until(b'\n', line)? == 0 {
        return Ok(false);
    }
    if line.pop_if(|last| *last == b'\n').is_none() {
        line.clear();
        file.skip_until(b'\n')?;
    }
    Ok(true)
}

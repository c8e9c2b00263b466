//! The chunks that an earlier run finished.

use super::Chunk;
use super::chunk_result::{ChunkResult, Tossed};
use super::earlier::Earlier;
use super::packed::Packed;
use super::unfinished::Beginnings;

/// Results of finished chunks, and of the beginnings of others, found by point and first toss.
#[derive(Debug, Default)]
pub(super) struct Finished {
    begun: Beginnings,
    /// What a run counted that this one extends.
    earlier: Earlier,
    /// Whether chunks may begin with tosses that are counted.
    with_beginnings: bool,
    /// In order of point and first toss.
    entries: Vec<Entry>,
    /// Those that were not taken, and their tosses.
    left: u64,
    tosses: u64,
}

#[derive(Debug)]
struct Entry {
    point: u32,
    start: u64,
    /// `None` once it was taken.
    result: Option<Packed>,
}

impl Finished {
    /// Of a chunk that occurs twice the first result is kept.
    pub(super) fn new(found: impl IntoIterator<Item = (Chunk, Packed)>) -> Self {
        let entry = |(chunk, result): (Chunk, Packed)| Entry {
            point: u32::try_from(chunk.point).unwrap_or(u32::MAX),
            start: chunk.tosses.start,
            result: Some(result),
        };
        let mut entries: Vec<Entry> = found.into_iter().map(entry).collect();
        entries.sort_by_key(Entry::key);
        entries.dedup_by_key(|entry| entry.key());
        let results = entries.iter().filter_map(|entry| entry.result.as_ref());
        let tosses = results.map(|packed| ChunkResult::from(packed).tosses());
        Self {
            begun: Beginnings::new(),
            earlier: Earlier::default(),
            with_beginnings: false,
            tosses: tosses.fold(0, u64::saturating_add),
            left: entries.len() as u64,
            entries,
        }
    }

    /// The same, and what is counted of chunks that are not finished.
    pub(super) fn with_beginnings(self, begun: Beginnings) -> Self {
        Self {
            begun,
            with_beginnings: true,
            ..self
        }
    }

    /// The same, and what a run counted that this one extends.
    pub(super) fn with_earlier(self, earlier: Earlier) -> Self {
        Self { earlier, ..self }
    }

    /// The counts of a chunk of which the run that this one extends has all tosses.
    pub(super) fn take_over(&self, chunk: &Chunk) -> Option<Tossed> {
        let tossed = self.earlier.beginning(chunk)?;
        (tossed.tally.tosses() == chunk.tosses.end - chunk.tosses.start).then_some(tossed)
    }

    /// Takes what is counted of a chunk that is not finished.
    pub(super) fn take_beginning(&mut self, chunk: &Chunk) -> Option<Tossed> {
        if !self.with_beginnings {
            return None;
        }
        let begun = self.begun.remove(&(chunk.point, chunk.tosses.start));
        let begun = begun.map(|(_, tossed)| tossed);
        let all = begun.into_iter().chain(self.earlier.beginning(chunk));
        let longest = all.max_by_key(|tossed| tossed.tally.tosses())?;
        // a forged one may be longer
        let tosses = chunk.tosses.end - chunk.tosses.start;
        (longest.tally.tosses() < tosses).then_some(longest)
    }

    /// Chunks that were not taken.
    pub(super) fn left(&self) -> u64 {
        self.left
    }

    /// Their tosses.
    pub(super) fn tosses(&self) -> u64 {
        self.tosses
    }

    /// Takes the result of the chunk of `point` that begins at toss `start`.
    pub(super) fn take(&mut self, point: usize, start: u64) -> Option<ChunkResult> {
        let key = (u32::try_from(point).ok()?, start);
        let index = self.entries.binary_search_by_key(&key, Entry::key).ok()?;
        let packed = self.entries[index].result.take()?;
        let result = ChunkResult::from(&packed);
        self.left -= 1;
        self.tosses = self.tosses.saturating_sub(result.tosses());
        Some(result)
    }

    /// Point and first toss of what was not taken.
    pub(super) fn rest(&self) -> impl Iterator<Item = (usize, u64)> {
        let rest = self.entries.iter().filter(|entry| entry.result.is_some());
        rest.map(|entry| (entry.point as usize, entry.start))
    }
}

impl Entry {
    fn key(&self) -> (u32, u64) {
        (self.point, self.start)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_core::Tally;

    fn tossed(tosses: u64) -> Tossed {
        Tossed {
            tally: Tally {
                heads: tosses,
                ..Tally::default()
            },
            microseconds: 0,
        }
    }

    fn chunk(tosses: std::ops::Range<u64>) -> Chunk {
        Chunk { point: 0, tosses }
    }

    /// A whole chunk is no beginning, and a forged one may be longer.
    #[test]
    fn a_beginning_is_shorter_than_its_chunk() {
        for (counted, is_taken) in [(1, true), (149, true), (150, false), (1000, false)] {
            let begun = [((0, 100), (chunk(100..100 + counted), tossed(counted)))];
            let mut finished = Finished::default().with_beginnings(begun.into());
            let taken = finished.take_beginning(&chunk(100..250));
            assert_eq!(taken, is_taken.then(|| tossed(counted)), "{counted}");
            // once
            assert_eq!(finished.take_beginning(&chunk(100..250)), None);
        }
    }

    #[test]
    fn what_is_not_taken_is_left() {
        let result = |tosses| Packed::from(&ChunkResult::Tossed(tossed(tosses)));
        let all = [(chunk(100..250), result(150)), (chunk(0..100), result(100))];
        let mut finished = Finished::new(all);
        assert_eq!((finished.left(), finished.tosses()), (2, 250));
        assert_eq!(finished.take(0, 7), None);
        assert_eq!(finished.take(0, 100).map(|taken| taken.tosses()), Some(150));
        assert_eq!(finished.take(0, 100), None);
        assert_eq!((finished.left(), finished.tosses()), (1, 100));
        assert!(finished.rest().eq([(0, 0)]));
    }
}

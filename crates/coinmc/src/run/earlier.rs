//! The tosses of the run that a run extends: what it counted, under the new plan, until that is finished.

use super::blocks::Blocks;
use super::chunk_result::{ChunkResult, Tossed};
use super::packed::Packed;
use super::replace::{self, Replacement};
use super::sealed::{seal, unseal};
use super::{Chunk, RunError, tally_text};
use crate::plan::Plan;
use std::fs::File;
use std::io::{self, BufReader, Write};
use std::path::Path;

/// Version of the file's format.
const FORMAT: u64 = 1;

/// Ranges of tosses that an earlier run counted, in order.
#[derive(Debug, Default)]
pub(super) struct Earlier {
    /// By point and first toss.
    ranges: Vec<(u32, u64, Packed)>,
}

impl Earlier {
    pub(super) const FILE: &'static str = "earlier.txt";
    /// The name of the file until the manifest names its plan: a run that extends another may itself be extended,
    /// and has its own file up to that instant.
    pub(super) const NEXT: &'static str = "earlier.next.txt";

    /// What the file of a run directory holds; nothing if it is not there, or of another plan. What is damaged is
    /// left out: it is tossed again.
    pub(super) fn read(dir: &Path, plan: &Plan, plan_hash: &str) -> Result<Self, RunError> {
        let next = dir.join(Self::NEXT);
        let path = if plan_of(&next)?.as_deref() == Some(plan_hash) {
            next
        } else {
            dir.join(Self::FILE)
        };
        let failed = |error| RunError::io("read", &path, error);
        let Some(file) = open(&path).map_err(failed)? else {
            return Ok(Self::default());
        };
        let mut blocks = Blocks::new(BufReader::new(file));
        let title = blocks.next().transpose().map_err(failed)?;
        if title.is_none_or(|block| block.bytes != heading(plan_hash).as_bytes()) {
            return Ok(Self::default());
        }
        let mut ranges = Vec::new();
        for block in blocks {
            let bytes = block.map_err(failed)?.bytes;
            let Some(chunk) = tally_text::chunk(&bytes) else {
                continue;
            };
            let is_tossed = chunk.point < plan.points.len()
                && plan.makes_tosses(chunk.point)
                && !chunk.tosses.is_empty();
            if is_tossed
                && let Ok(tossed) = tally_text::decode(&bytes, &chunk, plan_hash)
                && let Ok(point) = u32::try_from(chunk.point)
            {
                let packed = Packed::from(&ChunkResult::Tossed(tossed));
                ranges.push((point, chunk.tosses.start, packed));
            }
        }
        ranges.sort_by_key(|(point, start, _)| (*point, *start));
        ranges.dedup_by_key(|(point, start, _)| (*point, *start));
        Ok(Self { ranges })
    }

    /// All of it.
    pub(super) fn all(&self) -> impl Iterator<Item = (Chunk, Tossed)> {
        self.ranges.iter().filter_map(|(point, start, packed)| {
            let ChunkResult::Tossed(tossed) = ChunkResult::from(packed) else {
                return None;
            };
            let tosses = *start..start + tossed.tally.tosses();
            let point = *point as usize;
            Some((Chunk { point, tosses }, tossed))
        })
    }

    /// The beginning of a chunk that is counted; `None` if there is none.
    pub(super) fn beginning(&self, chunk: &Chunk) -> Option<Tossed> {
        let key = (u32::try_from(chunk.point).ok()?, chunk.tosses.start);
        let ranges = &self.ranges;
        let first = ranges.binary_search_by_key(&key, |(point, start, _)| (*point, *start));
        let (mut end, mut sum) = (chunk.tosses.start, Tossed::none());
        for (point, start, packed) in &ranges[first.ok()?..] {
            let ChunkResult::Tossed(tossed) = ChunkResult::from(packed) else {
                break;
            };
            let tosses = tossed.tally.tosses();
            if (*point, *start) != (key.0, end) || tosses > chunk.tosses.end - end {
                break;
            }
            sum.tally = sum.tally.checked_merge(&tossed.tally)?;
            sum.microseconds = sum.microseconds.saturating_add(tossed.microseconds);
            end += tosses;
        }
        (end > chunk.tosses.start).then_some(sum)
    }
}

/// The file while it is being written; it is [`Earlier::NEXT`] only when it is whole.
pub(super) struct Writing(Replacement);

impl Writing {
    pub(super) fn begin(dir: &Path, plan_hash: &str) -> Result<Self, RunError> {
        let file = Replacement::begin(&dir.join(Earlier::NEXT))?;
        let mut writing = Self(file);
        writing.write(&heading(plan_hash))?;
        Ok(writing)
    }

    /// Adds tosses that are counted.
    pub(super) fn add(
        &mut self,
        chunk: &Chunk,
        tossed: &Tossed,
        plan_hash: &str,
    ) -> Result<(), RunError> {
        self.write(&tally_text::encode(chunk, tossed, plan_hash))
    }

    fn write(&mut self, text: &str) -> Result<(), RunError> {
        let written = self.0.writer().write_all(text.as_bytes());
        written.map_err(|error| self.0.error(error))
    }

    pub(super) fn finish(self) -> Result<(), RunError> {
        self.0.finish()
    }
}

/// The first text of the file.
fn heading(plan_hash: &str) -> String {
    seal(format!("coinmc earlier {FORMAT}\nplan {plan_hash}\n"))
}

/// The hash of the plan in the first text of a file; `None` if the file is not there or says none.
pub(super) fn plan_of(path: &Path) -> Result<Option<String>, RunError> {
    let failed = |error| RunError::io("read", path, error);
    let Some(file) = open(path).map_err(failed)? else {
        return Ok(None);
    };
    let first = Blocks::new(BufReader::new(file)).next();
    let bytes = first.transpose().map_err(failed)?.map(|block| block.bytes);
    let plan = |bytes: &[u8]| {
        let line = unseal(bytes).ok()?.lines().nth(1)?;
        line.strip_prefix("plan ").map(str::to_owned)
    };
    Ok(bytes.and_then(|bytes| plan(&bytes)))
}

fn open(path: &Path) -> io::Result<Option<File>> {
    match replace::open_file(path) {
        Ok(file) => Ok(Some(file)),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(error),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::finished::Finished;
    use crate::run::schedule::tests::{chunk, plan};
    use coinmc_core::Tally;
    use std::ops::Range;
    use tempfile::tempdir;

    const STOP: &str = "tosses = 1000";

    /// So many tosses, of 3 µs each.
    fn tossed(tosses: u64) -> Tossed {
        Tossed {
            tally: Tally {
                heads: tosses,
                ..Tally::default()
            },
            microseconds: 3 * tosses,
        }
    }

    /// What is read of a file of these ranges.
    fn written(ranges: &[(usize, Range<u64>)]) -> Earlier {
        let (plan, dir) = (plan(STOP), tempdir().unwrap());
        let mut writing = Writing::begin(dir.path(), "a hash").unwrap();
        for (point, tosses) in ranges {
            let counts = tossed(tosses.end - tosses.start);
            let chunk = chunk(*point, tosses.clone());
            writing.add(&chunk, &counts, "a hash").unwrap();
        }
        writing.finish().unwrap();
        assert!(
            Earlier::read(dir.path(), &plan, "another")
                .unwrap()
                .ranges
                .is_empty()
        );
        Earlier::read(dir.path(), &plan, "a hash").unwrap()
    }

    #[test]
    fn what_is_written_is_read_in_order_and_once() {
        let earlier = written(&[(1, 0..50), (0, 100..250), (0, 0..100), (0, 100..250)]);
        let expected = [(0, 0..100), (0, 100..250), (1, 0..50)];
        let expected = expected.map(|(point, tosses)| {
            let counts = tossed(tosses.end - tosses.start);
            (chunk(point, tosses), counts)
        });
        assert!(earlier.all().eq(expected));
    }

    /// What is not there holds nothing; what cannot be read is an error.
    #[test]
    fn a_file_that_cannot_be_read_is_told() {
        let (plan, dir) = (plan(STOP), tempdir().unwrap());
        let read = || Earlier::read(dir.path(), &plan, "a hash");
        assert!(read().unwrap().ranges.is_empty());
        for name in [Earlier::FILE, Earlier::NEXT] {
            let place = dir.path().join(name);
            std::fs::create_dir(&place).unwrap();
            assert!(matches!(read(), Err(RunError::Io { .. })), "{name}");
            std::fs::remove_dir(&place).unwrap();
        }
    }

    #[test]
    fn what_the_plan_does_not_toss_is_left_out() {
        let earlier = written(&[(0, 5..5), (1, 0..50), (2, 0..50)]);
        assert!(earlier.all().eq([(chunk(1, 0..50), tossed(50))]));
    }

    #[test]
    fn a_chunk_is_taken_over_if_all_of_it_is_there() {
        let earlier = written(&[(0, 100..150), (0, 150..250), (0, 250..300)]);
        let finished = Finished::default().with_earlier(earlier);
        assert_eq!(finished.take_over(&chunk(0, 100..250)), Some(tossed(150)));
        for lacks in [100..249, 100..301, 0..250] {
            assert_eq!(finished.take_over(&chunk(0, lacks)), None);
        }
    }

    /// Ranges that follow on each other make one beginning, up to a gap or to a range that is longer than what is
    /// left of the chunk.
    #[test]
    fn a_chunk_begins_with_the_ranges_that_fit_into_it() {
        let earlier = written(&[(0, 0..100), (0, 100..250), (0, 300..400), (1, 0..50)]);
        for (point, tosses, counted) in [
            (0, 0..1000, 250),
            (0, 0..250, 250),
            (0, 0..249, 100),
            (0, 0..200, 100),
            (0, 0..99, 0),
            (0, 100..250, 150),
            (0, 100..200, 0),
            (0, 250..1000, 0),
            (0, 300..1000, 100),
            (1, 0..1000, 50),
            (1, 50..1000, 0),
        ] {
            let begun = earlier.beginning(&chunk(point, tosses.clone()));
            let expected = (counted > 0).then(|| tossed(counted));
            assert_eq!(begun, expected, "{point} {tosses:?}");
        }
    }
}

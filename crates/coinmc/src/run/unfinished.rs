//! What is counted of chunks that are not finished, so that a run that is stopped loses a second of its work.

use super::blocks::Blocks;
use super::chunk_result::{ChunkResult, Tossed};
use super::cut::Cut;
use super::replace;
use super::tallies::Tallies;
use super::{Chunk, RunError};
use crate::plan::Plan;
use std::collections::BTreeMap;
use std::io::{self, BufReader};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// More beginnings than threads can have left behind are not read.
const MOST: usize = 1 << 16;

/// The beginnings of chunks, by point and first toss: the tosses counted, and their counts.
pub(super) type Beginnings = BTreeMap<(usize, u64), (Chunk, Tossed)>;

/// The file of the beginnings of chunks: small, and replaced as a whole.
#[derive(Debug)]
pub(super) struct Unfinished {
    path: PathBuf,
    beginnings: Mutex<Beginnings>,
}

impl Unfinished {
    pub(super) const FILE: &'static str = "unfinished.txt";

    /// The file of the run directory `dir`, which nobody else writes.
    pub(super) fn open(dir: &Path, tallies: &Tallies, plan: &Plan) -> Result<Self, RunError> {
        Ok(Self {
            path: dir.join(Self::FILE),
            beginnings: Mutex::new(read(dir, tallies, plan)?),
        })
    }

    /// What an earlier run has begun.
    pub(super) fn begun(&self) -> Beginnings {
        self.lock().clone()
    }

    /// Replaces the beginnings of these chunks, and forgets those of chunks that are finished.
    pub(super) fn update<'a>(
        &self,
        tallies: &Tallies,
        begun: impl Iterator<Item = (&'a Chunk, Tossed)>,
        finished: impl Iterator<Item = &'a Chunk>,
    ) -> Result<(), RunError> {
        let mut beginnings = self.lock();
        let (before, mut is_new) = (beginnings.len(), false);
        for (chunk, tossed) in begun {
            beginnings.insert(key(chunk), (chunk.clone(), tossed));
            is_new = true;
        }
        for chunk in finished {
            beginnings.remove(&key(chunk));
        }
        // a beginning of a finished chunk may stay for a while: the finished chunk is what counts
        if is_new || (before > 0 && beginnings.is_empty()) {
            self.write(tallies, &beginnings)?;
        }
        Ok(())
    }

    /// Forgets all: the run is finished.
    pub(super) fn clear(&self) -> Result<(), RunError> {
        self.lock().clear();
        replace::remove(&self.path)
    }

    fn write(&self, tallies: &Tallies, beginnings: &Beginnings) -> Result<(), RunError> {
        if beginnings.is_empty() {
            return replace::remove(&self.path);
        }
        let texts = beginnings.values();
        let texts = texts.map(|(chunk, tossed)| tallies.text(chunk, &ChunkResult::Tossed(*tossed)));
        replace::replace(&self.path, texts.collect::<String>().as_bytes())
    }

    /// A poisoned lock is ignored: a panic under the lock ends the whole run anyway.
    fn lock(&self) -> MutexGuard<'_, Beginnings> {
        self.beginnings
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
    }
}

fn key(chunk: &Chunk) -> (usize, u64) {
    (chunk.point, chunk.tosses.start)
}

/// What a run directory has begun. What is damaged is left out: it is counted anew.
pub(super) fn read(dir: &Path, tallies: &Tallies, plan: &Plan) -> Result<Beginnings, RunError> {
    let path = dir.join(Unfinished::FILE);
    let failed = |error| RunError::io("read", &path, error);
    let file = match replace::open_file(&path) {
        Ok(file) => file,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Beginnings::new()),
        Err(error) => return Err(failed(error)),
    };
    let cut = Cut::new(plan);
    let mut beginnings = Beginnings::new();
    for block in Blocks::new(BufReader::new(file)).take(MOST) {
        let bytes = block.map_err(failed)?.bytes;
        if let Ok((chunk, tossed)) = tallies.read_beginning(&bytes, plan, &cut) {
            beginnings.insert(key(&chunk), (chunk, tossed));
        }
    }
    Ok(beginnings)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::schedule::tests::plan;
    use coinmc_core::Tally;
    use tempfile::tempdir;

    const STOP: &str = "tosses = 1000";

    /// The first tosses of a point.
    fn begun(point: usize, counted: u64) -> (Chunk, Tossed) {
        let chunk = Chunk {
            point,
            tosses: 0..counted,
        };
        let tally = Tally {
            heads: counted,
            ..Tally::default()
        };
        let microseconds = 0;
        (
            chunk,
            Tossed {
                tally,
                microseconds,
            },
        )
    }

    #[test]
    fn the_file_holds_the_beginnings_of_chunks_that_are_not_finished() {
        let (plan, dir) = (plan(STOP), tempdir().unwrap());
        let tallies = Tallies::of(dir.path(), plan.hash());
        let unfinished = Unfinished::open(dir.path(), &tallies, &plan).unwrap();
        let update = |begun: &[(Chunk, Tossed)], finished: &[&Chunk]| {
            let begun = begun.iter().map(|(chunk, tossed)| (chunk, *tossed));
            unfinished
                .update(&tallies, begun, finished.iter().copied())
                .unwrap();
        };
        let stored = || -> Vec<_> {
            let read = read(dir.path(), &tallies, &plan).unwrap();
            read.into_values().collect()
        };
        assert_eq!(stored(), []);
        let ([one, more], other) = ([100, 200].map(|counted| begun(0, counted)), begun(1, 300));
        update(&[one, other.clone()], &[]);
        // of a chunk the last
        update(std::slice::from_ref(&more), &[]);
        assert_eq!(stored(), [more.clone(), other.clone()]);
        assert!(unfinished.begun().into_values().eq(stored()));
        // the file is gone with the last of them
        update(&[], &[&more.0]);
        assert!(!unfinished.begun().contains_key(&(0, 0)));
        // for which it is not written
        assert_eq!(stored(), [more, other.clone()]);
        update(&[], &[&other.0]);
        assert!(!dir.path().join(Unfinished::FILE).exists());
        update(&[other], &[]);
        unfinished.clear().unwrap();
        assert!(unfinished.begun().is_empty() && stored().is_empty());
    }

    #[test]
    fn a_file_that_cannot_be_read_is_told() {
        let (plan, dir) = (plan(STOP), tempdir().unwrap());
        std::fs::create_dir(dir.path().join(Unfinished::FILE)).unwrap();
        let tallies = Tallies::of(dir.path(), plan.hash());
        let read = read(dir.path(), &tallies, &plan);
        assert!(matches!(read, Err(RunError::Io { .. })), "{read:?}");
    }
}

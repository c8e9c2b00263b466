//! The file of finished chunks: reads what is there, adds what is new, and brings it into order.

use super::append::append;
use super::blocks::{Block, Blocks};
use super::chunk_result::{ChunkResult, Tossed, whole};
use super::cut::Cut;
use super::damage::Damage;
use super::replace::{self, Replacement};
use super::sealed::MAX_BYTES;
use super::{Chunk, RunError, integral_text, tally_text};
use crate::plan::Plan;
use std::collections::HashSet;
use std::fs::{File, OpenOptions};
use std::io::{self, BufReader, Read, Seek, SeekFrom, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// The file that holds one text for each finished chunk.
#[derive(Debug)]
pub(super) struct Tallies {
    path: PathBuf,
    plan_hash: String,
}

/// A stretch of the file.
#[derive(Debug)]
pub(super) enum Entry {
    /// A finished chunk.
    Finished(Chunk, Box<ChunkResult>),
    /// A stretch that is rejected.
    Damaged(Damage, Range<u64>),
    /// The end that a killed run did not finish writing.
    Torn(Range<u64>),
}

impl Tallies {
    pub(super) const FILE: &'static str = "tallies.txt";
    /// Holds what was rejected.
    pub(super) const REJECTED: &'static str = "tallies.rejected.txt";

    /// The tallies of the run directory `dir`.
    pub(super) fn of(dir: &Path, plan_hash: String) -> Self {
        Self {
            path: dir.join(Self::FILE),
            plan_hash,
        }
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Visits everything in the file, in the order in which it was written.
    pub(super) fn scan(
        &self,
        plan: &Plan,
        cut: &Cut,
        mut found: impl FnMut(Entry) -> Result<(), RunError>,
    ) -> Result<(), RunError> {
        let Some(file) = self.file()? else {
            return Ok(());
        };
        for block in Blocks::new(BufReader::new(file)) {
            let block = block.map_err(|error| self.error("read", error))?;
            let entry = if block.is_closed {
                match self.read(&block.bytes, plan, cut) {
                    Ok((chunk, result)) => Entry::Finished(chunk, Box::new(result)),
                    Err(damage) => Entry::Damaged(damage, block.place),
                }
            } else {
                Entry::Torn(block.place)
            };
            found(entry)?;
        }
        Ok(())
    }

    /// The file, if it is there.
    fn file(&self) -> Result<Option<File>, RunError> {
        match replace::open_file(&self.path) {
            Ok(file) => Ok(Some(file)),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(self.error("open", error)),
        }
    }

    fn error(&self, action: &'static str, error: io::Error) -> RunError {
        RunError::io(action, &self.path, error)
    }

    /// Reads the text of a chunk.
    pub(super) fn read(
        &self,
        bytes: &[u8],
        plan: &Plan,
        cut: &Cut,
    ) -> Result<(Chunk, ChunkResult), Damage> {
        let mut chunk = named_chunk(bytes, plan, cut)?;
        let point = chunk.point;
        let hash = &self.plan_hash;
        if plan.integrates(point)
            && let Some(method) = plan.method(point)
        {
            let integral = integral_text::decode(bytes, point, method, hash)?;
            return Ok((chunk, ChunkResult::Integrated(integral)));
        }
        if cut.may_be_shorter() {
            shorten(&mut chunk, bytes);
        }
        let tossed = tally_text::decode(bytes, &chunk, hash)?;
        Ok((chunk, ChunkResult::Tossed(tossed)))
    }

    /// Reads the text of the beginning of a chunk of tosses.
    pub(super) fn read_beginning(
        &self,
        bytes: &[u8],
        plan: &Plan,
        cut: &Cut,
    ) -> Result<(Chunk, Tossed), Damage> {
        let mut chunk = named_chunk(bytes, plan, cut)?;
        if plan.integrates(chunk.point) {
            return Err(Damage::NoSuchChunk);
        }
        shorten(&mut chunk, bytes);
        let tossed = tally_text::decode(bytes, &chunk, &self.plan_hash)?;
        Ok((chunk, tossed))
    }

    /// The text of a finished chunk.
    pub(super) fn text(&self, chunk: &Chunk, result: &ChunkResult) -> String {
        match result {
            ChunkResult::Tossed(tossed) => tally_text::encode(chunk, tossed, &self.plan_hash),
            ChunkResult::Integrated(integral) => {
                integral_text::encode(chunk.point, integral, &self.plan_hash)
            }
        }
    }

    /// Adds finished chunks durably: one write, one sync.
    pub(super) fn store<'a>(
        &self,
        batch: impl Iterator<Item = (&'a Chunk, &'a ChunkResult)>,
    ) -> Result<(), RunError> {
        let texts = batch.map(|(chunk, result)| self.text(chunk, result));
        let text: String = texts.collect();
        if text.is_empty() {
            return Ok(());
        }
        append(&self.path, text.as_bytes(), true)
    }

    /// Cuts off the end that a killed run did not finish writing.
    pub(super) fn cut_at(&self, end: u64) -> Result<(), RunError> {
        let file = OpenOptions::new().write(true).open(&self.path);
        let cut = file.and_then(|file| file.set_len(end).and_then(|()| file.sync_data()));
        cut.map_err(|error| self.error("cut", error))
    }

    /// Brings the chunks into the order of points and tosses, which is that of no thread. Moves stretches
    /// that are rejected, and chunks, given by point and first toss, that are not needed, to the file of
    /// what was rejected. A file that is in order is left alone.
    pub(super) fn put_in_order(
        &self,
        rejected: &[Range<u64>],
        unneeded: &[(usize, u64)],
    ) -> Result<(), RunError> {
        let Some(file) = self.file()? else {
            return Ok(());
        };
        let failed = |error| self.error("read", error);
        let unneeded: HashSet<_> = unneeded.iter().copied().collect();
        let begins: HashSet<u64> = rejected.iter().map(|place| place.start).collect();
        let (mut keep, mut reject) = (Vec::new(), Vec::new());
        for block in Blocks::new(BufReader::new(&file)) {
            let Block { place, bytes, .. } = block.map_err(failed)?;
            match self::place(&bytes) {
                Some(key) if !begins.contains(&place.start) && !unneeded.contains(&key) => {
                    keep.push((key, place));
                }
                _ => reject.push(place),
            }
        }
        if reject.is_empty() && keep.windows(2).all(|pair| pair[0].0 < pair[1].0) {
            return Ok(());
        }
        self.keep_rejected(&file, &reject)?;
        // stable: of a chunk that occurs twice the first stays
        keep.sort_by_key(|(key, _)| *key);
        keep.dedup_by_key(|(key, _)| *key);
        let mut ordered = Replacement::begin(&self.path)?;
        let places = keep.into_iter().map(|(_, place)| place);
        let copied = copy(&file, places, &mut ordered.writer());
        copied.map_err(|error| ordered.error(error))?;
        ordered.finish()?;
        replace::sync_directory(self.path.parent().unwrap_or(Path::new(".")))
    }

    /// Adds stretches to the file of what was rejected.
    fn keep_rejected(&self, file: &File, places: &[Range<u64>]) -> Result<(), RunError> {
        if places.is_empty() {
            return Ok(());
        }
        let path = self.path.with_file_name(Self::REJECTED);
        let earlier = replace::is_file(&path)
            .then(|| replace::open_file(&path))
            .transpose()
            .map_err(|error| RunError::io("read", &path, error))?;
        let mut all = Replacement::begin(&path)?;
        let mut writer = all.writer();
        let written = earlier
            .map_or(Ok(0), |mut earlier| io::copy(&mut earlier, &mut writer))
            .and_then(|_| copy(file, places.iter().cloned(), &mut writer));
        drop(writer);
        written.map_err(|error| all.error(error))?;
        all.finish()
    }
}

/// The longest chunk of the plan that begins where a text says.
fn named_chunk(bytes: &[u8], plan: &Plan, cut: &Cut) -> Result<Chunk, Damage> {
    if bytes.len() > MAX_BYTES {
        return Err(Damage::TooLong);
    }
    let (point, start) = place(bytes).ok_or(Damage::Checksum)?;
    chunk_at(plan, cut, point, start).ok_or(Damage::NoSuchChunk)
}

/// Lets a chunk end where its text says, if that is earlier.
fn shorten(chunk: &mut Chunk, bytes: &[u8]) {
    if let Some(end) = tally_text::end(bytes) {
        chunk.tosses.end = chunk.tosses.end.min(end);
    }
}

/// Copies stretches of a file. Neighbours are read as one.
fn copy(
    file: &File,
    places: impl Iterator<Item = Range<u64>>,
    out: &mut impl Write,
) -> io::Result<()> {
    let mut file = file;
    let mut copy = |place: Range<u64>| {
        file.seek(SeekFrom::Start(place.start))?;
        io::copy(&mut file.take(place.end - place.start), out).map(drop)
    };
    let mut pending = 0..0;
    for place in places {
        if pending.end == place.start {
            pending.end = place.end;
        } else {
            copy(std::mem::replace(&mut pending, place))?;
        }
    }
    copy(pending)
}

/// Point and first toss that a text names; 0 for the one chunk of an integrated point.
fn place(bytes: &[u8]) -> Option<(usize, u64)> {
    let text = std::str::from_utf8(bytes).ok()?;
    let mut lines = text.lines().skip(2);
    let point = lines.next()?.strip_prefix("point ")?.parse().ok()?;
    let start = match lines.next()?.strip_prefix("tosses ") {
        Some(range) => range.split_once(' ')?.0.parse().ok()?,
        None => 0,
    };
    Some((point, start))
}

/// The chunk of a point that begins at toss `start`, if the plan has one.
fn chunk_at(plan: &Plan, cut: &Cut, point: usize, start: u64) -> Option<Chunk> {
    if point >= plan.points.len() {
        None
    } else if plan.integrates(point) {
        (start == 0).then(|| whole(point))
    } else if plan.makes_tosses(point) {
        cut.chunk_at(point, start)
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::schedule::tests::plan_of_one;

    #[test]
    fn a_text_is_too_long_only_if_it_is_longer_than_the_longest() {
        let plan = plan_of_one("tosses = 1000");
        let tallies = Tallies::of(Path::new(""), plan.hash());
        for (bytes, damage) in [
            (MAX_BYTES, Damage::Checksum),
            (MAX_BYTES + 1, Damage::TooLong),
            (10 * MAX_BYTES, Damage::TooLong),
        ] {
            let read = tallies.read(&vec![b'x'; bytes], &plan, &Cut::new(&plan));
            assert_eq!(read.unwrap_err(), damage, "{bytes}");
        }
    }
}

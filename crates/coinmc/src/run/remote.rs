//! Chunks that one process computes for the run of another.

use super::chunk::compute_chunk;
use super::chunk_result::{ChunkResult, Tossed};
use super::cut::Cut;
use super::made::Made;
use super::provenance::{Effort, Maker};
use super::tallies::Tallies;
use super::{Chunk, RunError};
use crate::plan::Plan;
use coinmc_core::Tally;
use serde::{Deserialize, Serialize};
use std::num::NonZeroUsize;
use std::path::Path;

/// Longest note that is read, bytes.
const MAX_NOTE: usize = 4096;

/// Who made a chunk, as it travels beside the chunk's text.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Note {
    pub(super) maker: Maker,
    pub(super) effort: Effort,
}

impl Note {
    fn text(&self) -> String {
        serde_json::to_string(self).expect("plain fields are always JSON")
    }

    pub(super) fn read(bytes: &[u8]) -> Result<Self, RunError> {
        let bad = |reason| RunError::BadResult { reason };
        if bytes.len() > MAX_NOTE {
            return Err(bad("its note is too long".to_owned()));
        }
        serde_json::from_slice(bytes).map_err(|error| bad(format!("its note: {error}")))
    }
}

/// Computes a chunk on so many threads (an integral on one) and returns its result as the text that a run directory
/// holds; `None` if `go_on`, which is called from time to time, returned false. The text depends on the plan and the
/// chunk alone.
///
/// # Errors
/// [`RunError::NoSuchChunk`] if the plan has no such chunk, [`RunError::Settings`] if an engine rejects its
/// settings, [`RunError::Thread`].
pub fn chunk_text(
    plan: &Plan,
    chunk: &Chunk,
    threads: NonZeroUsize,
    go_on: impl Fn() -> bool + Sync,
) -> Result<Option<String>, RunError> {
    let made = compute(plan, chunk, threads, go_on)?;
    Ok(made.map(|made| text(plan, chunk, &made.result)))
}

/// The same with a note of who made the chunk and how long it took, for the record of the run: see
/// [`Delivery`](super::Delivery). `build` is how it names this build of the program.
///
/// # Errors
/// Those of [`chunk_text`].
///
/// # Example
/// ```
/// use coinmc::run::{Delivery, Session, Step, chunk_with_note};
/// use std::num::NonZeroUsize;
/// let plan = coinmc::config::parse(
///     "inline",
///     "coin.ratio = 1.0\nsurface = { restitution = 0.5, friction = 0.3 }\n\
///      launch.preset = 'robot'\nengine.flat = {}\nstop.tosses = 1000",
///     &[],
/// ).unwrap();
/// let mut session = Session::in_memory(&plan);
/// while let Step::Chunk(chunk) = session.next() {
///     // on any machine
///     let (text, note) = chunk_with_note(&plan, &chunk, "0.1.0", NonZeroUsize::MIN, || true)?.unwrap();
///     session.accept([Delivery { text: text.as_bytes(), note: note.as_bytes() }])?;
/// }
/// assert_eq!(session.conclude(&())?.tosses, 1000);
/// # Ok::<(), coinmc::run::RunError>(())
/// ```
pub fn chunk_with_note(
    plan: &Plan,
    chunk: &Chunk,
    build: &str,
    threads: NonZeroUsize,
    go_on: impl Fn() -> bool + Sync,
) -> Result<Option<(String, String)>, RunError> {
    let made = compute(plan, chunk, threads, go_on)?;
    Ok(made.map(|made| {
        let note = Note {
            maker: Maker::this(plan, build),
            effort: made.effort,
        };
        (text(plan, chunk, &made.result), note.text())
    }))
}

fn compute(
    plan: &Plan,
    chunk: &Chunk,
    threads: NonZeroUsize,
    go_on: impl Fn() -> bool + Sync,
) -> Result<Option<Made>, RunError> {
    if chunk.point >= plan.points.len() {
        return Err(RunError::NoSuchChunk {
            chunk: chunk.clone(),
            points: plan.points.len(),
        });
    }
    compute_chunk(plan, chunk.clone(), threads, go_on)
}

fn text(plan: &Plan, chunk: &Chunk, result: &ChunkResult) -> String {
    Tallies::of(Path::new(""), plan.hash()).text(chunk, result)
}

/// The text of a chunk of which a tally is given: for whoever simulates a run.
pub fn text_of_tally(plan: &Plan, chunk: &Chunk, tally: &Tally) -> String {
    let tossed = Tossed {
        tally: *tally,
        microseconds: 0,
    };
    text(plan, chunk, &ChunkResult::Tossed(tossed))
}

/// The chunk of this number, where the number of tosses is fixed; `None` if there is none.
pub fn numbered_chunk(plan: &Plan, number: u64) -> Option<Chunk> {
    Cut::new(plan).numbered(plan, number)
}

/// How many chunks a run has, where the number of tosses is fixed; those of points without tosses are
/// numbered, too.
pub fn chunks(plan: &Plan) -> Option<u64> {
    let chunks_a_point = Cut::new(plan).chunks_a_point()?;
    chunks_a_point.checked_mul(plan.points.len() as u64)
}

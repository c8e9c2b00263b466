//! A run of which the caller decides where its chunks are computed: in other processes, on a cluster.

use super::chunk_result::ChunkResult;
use super::cut::Cut;
use super::directory::RunDirectory;
use super::finished::Finished;
use super::in_directory::conclude;
use super::provenance::{Entry, Maker};
use super::remote::Note;
use super::report::{report, status};
use super::schedule::{Job, Next, Schedule};
use super::tallies::Tallies;
use super::{Chunk, Part, Progress, ProgressSink, Report, RunError};
use crate::plan::Plan;
use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::Path;
use std::sync::Arc;

/// A run of which the caller decides where its chunks are computed. It hands out chunks and takes their
/// results as texts, by which they travel between processes and are stored.
///
/// In a run directory it is the same run as that of [`run`](super::run()): either resumes the other, and
/// both end in the same bytes.
///
/// # Example
/// ```
/// use coinmc::run::{Delivery, Session, Step, chunk_text};
/// use std::num::NonZeroUsize;
/// let plan = coinmc::config::parse(
///     "inline",
///     "coin.ratio = [1.0, 2.0]\nsurface = { restitution = 0.5, friction = 0.3 }\n\
///      launch.preset = 'robot'\nengine.flat = {}\nstop.tosses = 1000",
///     &[],
/// ).unwrap();
/// let mut session = Session::in_memory(&plan);
/// while let Step::Chunk(chunk) = session.next() {
///     // on any machine
///     let text = chunk_text(&plan, &chunk, NonZeroUsize::MIN, || true)?.unwrap();
///     session.accept([Delivery::from(text.as_bytes())])?;
/// }
/// let report = session.conclude(&())?;
/// assert_eq!((report.tosses, report.results.rows.len()), (2000, 2));
/// # Ok::<(), coinmc::run::RunError>(())
/// ```
#[derive(Debug)]
pub struct Session {
    plan: Arc<Plan>,
    cut: Cut,
    tallies: Tallies,
    directory: Option<RunDirectory>,
    schedule: Schedule,
    /// Chunks that were handed out, by point and first toss, with the toss after the last.
    awaited: HashMap<(usize, u64), u64>,
}

/// The result of a chunk as it travels between processes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Delivery<'a> {
    /// What [`chunk_text`](super::chunk_text) made.
    pub text: &'a [u8],
    /// Who made it, as [`chunk_with_note`](super::chunk_with_note) tells it; empty where nobody does.
    pub note: &'a [u8],
}

impl<'a> From<&'a [u8]> for Delivery<'a> {
    /// The result of a chunk of which nobody tells who made it.
    fn from(text: &'a [u8]) -> Self {
        Self { text, note: &[] }
    }
}

/// A result that is counted, and who made it.
struct Accepted {
    chunk: Chunk,
    result: ChunkResult,
    note: Option<Note>,
}

/// What is next.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Step {
    /// Compute this chunk.
    Chunk(Chunk),
    /// Wait for the result of a chunk: it decides what is next.
    Wait,
    /// Nothing: the run is complete.
    Done,
}

impl Session {
    /// Starts a run in a run directory, or resumes the one that it holds. `build` is how the directory names
    /// this build of the program.
    ///
    /// # Errors
    /// What [`run`](super::run()) says about a directory it cannot use.
    pub fn open(
        plan: &Plan,
        out: &Path,
        build: &str,
        sink: &dyn ProgressSink,
    ) -> Result<Self, RunError> {
        let directory = RunDirectory::open(out, plan, Part::WHOLE, build, sink)?;
        let finished = directory.finished(plan, sink)?;
        let tallies = Tallies::of(out, plan.hash());
        Ok(Self::new(plan, tallies, Some(directory), finished))
    }

    /// A run without files.
    pub fn in_memory(plan: &Plan) -> Self {
        let tallies = Tallies::of(Path::new(""), plan.hash());
        Self::new(plan, tallies, None, Finished::default())
    }

    fn new(
        plan: &Plan,
        tallies: Tallies,
        directory: Option<RunDirectory>,
        finished: Finished,
    ) -> Self {
        let plan = Arc::new(plan.clone());
        Self {
            schedule: Schedule::new(&plan, Part::WHOLE, finished),
            cut: Cut::new(&plan),
            plan,
            tallies,
            directory,
            awaited: HashMap::new(),
        }
    }

    /// The next thing to do.
    #[allow(
        clippy::should_implement_trait,
        reason = "not an iterator: it may have to wait"
    )]
    pub fn next(&mut self) -> Step {
        match self.schedule.next() {
            // beginnings are no chunks that travel
            Next::Chunk(Job { chunk, .. }) => {
                let key = (chunk.point, chunk.tosses.start);
                self.awaited.insert(key, chunk.tosses.end);
                Step::Chunk(chunk)
            }
            Next::Wait => Step::Wait,
            Next::Done => Step::Done,
        }
    }

    /// Stores results and counts them: on the disk with one sync, so many at once are cheap. The result of a
    /// chunk that is not awaited, because it came twice, is ignored.
    ///
    /// # Errors
    /// [`RunError::BadResult`] if a text or a note is damaged, or of another plan, and those of the disk. Then
    /// none is counted.
    pub fn accept<'a>(
        &mut self,
        deliveries: impl IntoIterator<Item = Delivery<'a>>,
    ) -> Result<(), RunError> {
        let deliveries = deliveries.into_iter().map(|delivery| self.read(delivery));
        let all: Vec<Accepted> = deliveries.collect::<Result<_, _>>()?;
        let (mut new, mut seen) = (Vec::new(), HashSet::new());
        for accepted in all {
            let Chunk { point, tosses } = &accepted.chunk;
            let key = (*point, tosses.start);
            if self.awaited.get(&key) == Some(&tosses.end) && seen.insert(key) {
                new.push(accepted);
            }
        }
        if let Some(directory) = &self.directory {
            store(directory, &new)?;
        }
        for Accepted { chunk, result, .. } in &new {
            self.awaited.remove(&(chunk.point, chunk.tosses.start));
            self.schedule.complete(chunk, result);
        }
        Ok(())
    }

    fn read(&self, delivery: Delivery<'_>) -> Result<Accepted, RunError> {
        let Delivery { text, note } = delivery;
        let read = self.tallies.read(text, &self.plan, &self.cut);
        let (chunk, result) = read.map_err(|damage| RunError::BadResult {
            reason: damage.to_string(),
        })?;
        let note = (!note.is_empty()).then(|| Note::read(note)).transpose()?;
        Ok(Accepted {
            chunk,
            result,
            note,
        })
    }

    /// Chunks that were handed out and whose results have not come.
    pub fn awaited(&self) -> usize {
        self.awaited.len()
    }

    /// How far the run is.
    pub fn progress(&self) -> Progress {
        self.schedule.progress()
    }

    /// Writes the results of the run, or of what is finished of it, and reports them.
    ///
    /// # Errors
    /// Those of the disk.
    pub fn conclude(self, sink: &dyn ProgressSink) -> Result<Report, RunError> {
        if let Some(directory) = &self.directory {
            return conclude(&self.plan, Part::WHOLE, self.schedule, directory, sink);
        }
        let status = status(Part::WHOLE, &self.schedule);
        Ok(report(&self.plan, status, self.schedule))
    }
}

/// Stores results, and before them who made them: a chunk that counts has a maker.
fn store(directory: &RunDirectory, new: &[Accepted]) -> Result<(), RunError> {
    let mut by_maker = BTreeMap::<&Maker, Vec<Entry>>::new();
    for Accepted { chunk, note, .. } in new {
        if let Some(note) = note {
            let entries = by_maker.entry(&note.maker).or_default();
            entries.push(Entry::new(chunk, note.effort));
        }
    }
    for (maker, entries) in by_maker {
        directory.provenance().add(maker, &entries)?;
    }
    let results = new.iter();
    directory
        .tallies()
        .store(results.map(|new| (&new.chunk, &new.result)))
}

//! A run of which the caller decides where its chunks are computed: in other processes, on a cluster.

use super::chunk::compute_chunk;
use super::chunk_result::{ChunkResult, Tossed};
use super::cut::Cut;
use super::directory::RunDirectory;
use super::finished::Finished;
use super::in_directory::conclude;
use super::report::{report, status};
use super::schedule::{Next, Schedule};
use super::tallies::Tallies;
use super::{Chunk, Part, Progress, ProgressSink, Report, RunError};
use crate::plan::Plan;
use coinmc_core::Tally;
use std::collections::HashMap;
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
/// use coinmc::run::{Session, Step, chunk_text};
/// let plan = coinmc::config::parse(
///     "inline",
///     "coin.ratio = [1.0, 2.0]\nsurface = { restitution = 0.5, friction = 0.3 }\n\
///      launch.preset = 'robot'\nengine.flat = {}\nstop.tosses = 1000",
///     &[],
/// ).unwrap();
/// let mut session = Session::in_memory(&plan);
/// while let Step::Chunk(chunk) = session.next() {
///     // on any machine
///     let text = chunk_text(&plan, &chunk, || true)?.unwrap();
///     session.accept([text.as_bytes()])?;
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
            Next::Chunk(chunk) => {
                let key = (chunk.point, chunk.tosses.start);
                self.awaited.insert(key, chunk.tosses.end);
                Step::Chunk(chunk)
            }
            Next::Wait => Step::Wait,
            Next::Done => Step::Done,
        }
    }

    /// Stores results, which [`chunk_text`] made, and counts them: on the disk with one sync, so many at
    /// once are cheap. The result of a chunk that is not awaited, because it came twice, is ignored.
    ///
    /// # Errors
    /// [`RunError::BadResult`] if a text is damaged or of another plan, and those of the disk. Then none is
    /// counted.
    pub fn accept<'a>(
        &mut self,
        texts: impl IntoIterator<Item = &'a [u8]>,
    ) -> Result<(), RunError> {
        let mut results = Vec::new();
        for text in texts {
            let read = self.tallies.read(text, &self.plan, &self.cut);
            let (chunk, result) = read.map_err(|damage| RunError::BadResult {
                reason: damage.to_string(),
            })?;
            let key = (chunk.point, chunk.tosses.start);
            if self.awaited.get(&key) == Some(&chunk.tosses.end) {
                self.awaited.remove(&key);
                results.push((chunk, result));
            }
        }
        if let Some(directory) = &self.directory {
            let stored = directory.tallies().store(&results);
            stored.inspect_err(|_| {
                let keys = results.iter().map(|(chunk, _)| chunk);
                let keys = keys.map(|chunk| ((chunk.point, chunk.tosses.start), chunk.tosses.end));
                self.awaited.extend(keys);
            })?;
        }
        for (chunk, result) in &results {
            self.schedule.complete(chunk, result);
        }
        Ok(())
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

/// Computes a chunk on this thread and returns its result as the text that a run directory holds; `None` if
/// `go_on`, which is called from time to time, returned false.
///
/// # Errors
/// [`RunError::NoSuchChunk`] if the plan has no such chunk, [`RunError::Settings`] if an engine rejects its
/// settings.
pub fn chunk_text(
    plan: &Plan,
    chunk: &Chunk,
    go_on: impl Fn() -> bool,
) -> Result<Option<String>, RunError> {
    if chunk.point >= plan.points.len() {
        return Err(RunError::NoSuchChunk {
            chunk: chunk.clone(),
            points: plan.points.len(),
        });
    }
    let tallies = Tallies::of(Path::new(""), plan.hash());
    let result = compute_chunk(plan, chunk, go_on)?;
    Ok(result.map(|result| tallies.text(chunk, &result)))
}

/// The text of a chunk of which a tally is given: for whoever simulates a run.
pub fn text_of_tally(plan: &Plan, chunk: &Chunk, tally: &Tally) -> String {
    let tossed = Tossed {
        tally: *tally,
        microseconds: 0,
    };
    Tallies::of(Path::new(""), plan.hash()).text(chunk, &ChunkResult::Tossed(tossed))
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

//! Who made the chunks of a run, and in how much time. Nothing of it enters what a run counts: it is in a file
//! of its own, which is not the same when the same run is made again.

mod effort;
mod log;
mod maker;
mod read;
mod record;

pub use effort::processor_time;
pub(super) use effort::{Effort, Stopwatch};
pub(super) use log::Log;
pub use maker::Maker;
pub(super) use maker::target;
pub(super) use read::Records;
pub(super) use record::{Entry, FILE};

use super::RunError;
use super::cut::Cut;
use super::tallies::{self, Tallies};
use crate::plan::Plan;
use serde_json::{Value, json};
use std::path::Path;
use std::time::Duration;

/// Who made a run.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Provenance {
    /// What each maker did, the first that worked on the run first.
    pub contributions: Vec<Contribution>,
    /// Finished chunks of which nothing is recorded: by a program that kept no record, or its record is damaged.
    pub unrecorded_chunks: u64,
}

/// What a maker did for a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Contribution {
    /// The build and the machine.
    pub maker: Maker,
    /// Chunks that it computed.
    pub chunks: u64,
    /// Tosses in them.
    pub tosses: u64,
    /// Time of the threads that computed them by the clock, added up.
    pub wall: Duration,
    /// The same of the processor; `None` where the system does not tell it.
    pub processor: Option<Duration>,
}

/// Who made the chunks of a run directory, finished or not. It is not changed.
///
/// `plan` is that of the run, as [`stored_plan`](super::stored_plan) or
/// [`stored_report`](super::stored_report) return it.
///
/// # Errors
/// [`RunError::Io`] if the directory cannot be read, [`RunError::NewerFormat`].
///
/// # Example
/// ```no_run
/// # fn example() -> Result<(), coinmc::run::RunError> {
/// let dir = std::path::Path::new("runs/first");
/// let plan = coinmc::run::stored_plan(dir)?;
/// for done in coinmc::run::provenance(dir, &plan)?.contributions {
///     println!("{}, {}: {} tosses in {} s", done.maker.build, done.maker.cpu, done.tosses, done.wall.as_secs());
/// }
/// # Ok(())
/// # }
/// ```
pub fn provenance(dir: &Path, plan: &Plan) -> Result<Provenance, RunError> {
    let records = Records::read(dir)?;
    let mut sums: Vec<Contribution> = records.makers().iter().map(Contribution::none).collect();
    let mut unrecorded_chunks = 0;
    Tallies::of(dir, plan.hash()).scan(plan, &Cut::new(plan), |entry| {
        if let tallies::Entry::Finished(chunk, _) = entry {
            let mut of_chunk = records.of(&chunk).peekable();
            unrecorded_chunks += u64::from(of_chunk.peek().is_none());
            for (entry, maker) in of_chunk {
                sums[maker].add(entry);
            }
        }
        Ok(())
    })?;
    sums.retain(|sum| sum.chunks > 0);
    Ok(Provenance {
        contributions: sums,
        unrecorded_chunks,
    })
}

impl Provenance {
    /// As JSON: a list with an object for each contribution, of the fields of [`Maker`] and [`Contribution`].
    pub fn to_json(&self) -> Value {
        let contributions = self.contributions.iter();
        contributions.map(Contribution::to_json).collect()
    }
}

impl Contribution {
    fn to_json(&self) -> Value {
        let Maker {
            build,
            features,
            target,
            cpu,
            lanes,
        } = &self.maker;
        json!({
            "build": build,
            "features": features,
            "target": target,
            "cpu": cpu,
            "lanes": lanes,
            "chunks": self.chunks,
            "tosses": self.tosses,
            "wall_s": self.wall.as_secs_f64(),
            "processor_s": self.processor.map(|time| time.as_secs_f64()),
        })
    }

    fn none(maker: &Maker) -> Self {
        Self {
            maker: maker.clone(),
            chunks: 0,
            tosses: 0,
            wall: Duration::ZERO,
            processor: Some(Duration::ZERO),
        }
    }

    fn add(&mut self, entry: &Entry) {
        let Effort { wall_us, cpu_us } = entry.effort();
        self.chunks += 1;
        self.tosses = self.tosses.saturating_add(entry.tosses());
        self.wall = self.wall.saturating_add(Duration::from_micros(wall_us));
        let of_cpu = self.processor.zip(cpu_us);
        self.processor = of_cpu.map(|(sum, us)| sum.saturating_add(Duration::from_micros(us)));
    }
}

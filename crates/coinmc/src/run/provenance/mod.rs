//! Who made the chunks of a run, and in how much time. Nothing of it enters what a run counts: it is in a file
//! of its own, which is not the same when the same run is made again.

mod effort;
mod log;
mod maker;
mod read;
mod record;

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
    /// Time of the threads that computed them by the clock, added up, s.
    pub wall_s: f64,
    /// The same of the processor, s; `None` where the system does not tell it.
    pub processor_s: Option<f64>,
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
///     println!("{}, {}: {} tosses in {} s", done.maker.build, done.maker.cpu, done.tosses, done.wall_s);
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
            match records.find(chunk.point, chunk.tosses.start) {
                Some((entry, maker)) => sums[maker].add(entry),
                None => unrecorded_chunks += 1,
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
            "wall_s": self.wall_s,
            "processor_s": self.processor_s,
        })
    }

    fn none(maker: &Maker) -> Self {
        Self {
            maker: maker.clone(),
            chunks: 0,
            tosses: 0,
            wall_s: 0.0,
            processor_s: Some(0.0),
        }
    }

    fn add(&mut self, entry: &Entry) {
        let Effort { wall_us, cpu_us } = entry.effort();
        self.chunks += 1;
        self.tosses = self.tosses.saturating_add(entry.tosses());
        self.wall_s += 1e-6 * wall_us as f64;
        let of_cpu = self.processor_s.zip(cpu_us);
        self.processor_s = of_cpu.map(|(sum, more)| sum + 1e-6 * more as f64);
    }
}

//! From a plan to results: chunks are executed on all cores and stored in the run directory as they
//! finish.
//!
//! ```text
//! Plan ──cut──▶ chunks ──workers──▶ tallies.txt ──▶ results.csv, results.parquet
//!                           ▲             │
//!                           └── a later run resumes from them
//! ```
//!
//! The counts depend on the plan alone: not on threads, parts, machine or order, nor on how often
//! the run was killed and resumed. The files are described in docs/reference/formats.md.
//!
//! # Example
//! ```no_run
//! use coinmc::run::{Options, Part, run};
//! use std::{path::Path, sync::atomic::AtomicBool};
//! # fn example(plan: &coinmc::plan::Plan) -> Result<(), coinmc::run::RunError> {
//! let cancel = AtomicBool::new(false);
//! let report = run(plan, &Options {
//!     out: Path::new("runs/first"),
//!     build: env!("CARGO_PKG_VERSION"),
//!     part: Part::WHOLE,
//!     threads: None,
//!     cancel: &cancel,
//!     sink: &(),
//! })?;
//! for row in &report.results.rows {
//!     println!("{:?}: {} in [{}, {}]", row.parameters, row.side.p, row.side.lo, row.side.hi);
//! }
//! # Ok(())
//! # }
//! ```

mod append;
mod blocks;
mod chunk;
mod chunk_result;
mod count;
mod cut;
mod damage;
mod directory;
mod each;
mod earlier;
mod error;
mod extend;
mod finished;
mod history;
mod in_directory;
mod integral_text;
mod made;
mod manifest;
mod merge;
mod missing;
mod options;
mod pace;
mod packed;
mod part;
mod pieces;
mod point_state;
mod progress;
mod provenance;
mod remote;
mod replace;
mod report;
mod schedule;
mod sealed;
mod session;
mod shares;
mod states;
mod stored;
mod tallies;
mod tally_text;
mod toss;
mod unfinished;
mod workers;

pub use chunk::{Chunk, run_chunk};
pub use chunk_result::integrate_point;
pub use count::{Count, count};
pub use directory::is_running;
use each::for_some_outcomes;
pub use each::{FinishedToss, TossSource, for_each_end, for_each_outcome};
pub use error::RunError;
pub use history::stored_chunks;
pub use in_directory::run;
pub use merge::{merge, merge_what_is_there, missing};
pub use missing::Missing;
pub use options::Options;
pub use part::{Part, PartError};
pub use progress::{Latest, Progress, ProgressSink};
pub use provenance::{Contribution, Maker, Provenance, processor_time, provenance};
pub use remote::{chunk_text, chunk_with_note, chunks, numbered_chunk, text_of_tally};
pub use report::{Report, Status};
pub use session::{Delivery, Session, Step};
pub use stored::{stored_plan, stored_report};
pub use toss::{stream, toss};

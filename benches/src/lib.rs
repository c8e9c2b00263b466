//! What the benchmarks and the studies share: named scenes, named pieces of work, reports.

mod case;
pub mod number;
mod output;
pub mod rapier;
mod report;
pub mod runs;
mod stopwatch;
mod workload;

pub use case::Case;
pub use output::Output;
pub use report::{Report, Table};
pub use stopwatch::Stopwatch;
pub use workload::{Workload, rough_workloads, space_workloads, workloads};

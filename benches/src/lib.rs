//! What the benchmarks and the studies have in common: named scenes and named pieces of work.

mod case;
mod workload;

pub use case::Case;
pub use workload::{Workload, space_workloads, workloads};

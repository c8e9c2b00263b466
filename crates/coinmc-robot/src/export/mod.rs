//! Tables from the journal: one row a throw, and the results of a run.

mod results;
mod throws;

pub use results::results;
pub use throws::{ThrowRow, rows, write_throws_csv, write_throws_parquet};

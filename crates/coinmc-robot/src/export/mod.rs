//! Tables from the journal: one row per throw, and the results in the format of a run.

mod results;
mod throws;

pub use results::results;
pub use throws::{
    ThrowRow, rows, throws_cell, throws_fields, write_throws_csv, write_throws_parquet,
};

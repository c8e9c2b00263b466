//! Config → plan → run → results.

pub mod config;
pub mod plan;
pub mod results;
pub mod run;

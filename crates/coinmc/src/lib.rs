//! Config → plan → run → results.

pub mod config;
pub mod plan;
pub mod published;
pub mod results;
pub mod run;
pub mod trace;

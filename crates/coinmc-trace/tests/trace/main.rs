//! Tests of replaying, recording, writing and searching.

mod errors;
mod files;
mod motion;
mod plans;
mod replay;
mod searching;

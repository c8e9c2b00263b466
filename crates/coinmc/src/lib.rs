#![doc = include_str!("../README.md")]
//!
//! # Config → plan → run → results
//! ```text
//! TOML ──config──▶ Plan ──run──▶ Report { Results } ──results──▶ CSV, Parquet, JSON
//!                   └─────count──▶  the same, without files
//! ```
//!
//! | to … | see |
//! |---|---|
//! | read a config, and report every mistake in it at once | [`config::load`], [`config::parse`] |
//! | ask what will be computed, and what is skipped and why | [`plan::Plan`] |
//! | run it in a directory that survives being killed | [`run::run`], [`run::merge`] |
//! | count in memory, or visit each toss | [`run::count`], [`run::for_each_outcome`] |
//! | write or read the table of results | [`results`] |
//! | find out how thick a fair coin is | [`results::fair_values`] |
//! | record the motion of a toss | the crate `coinmc-trace` |
//! | compare with published counts | [`published`] |
//!
//! To toss coins without configs, take an engine: [`coinmc_flat`] in a plane, [`coinmc_volumetric`]
//! in space, or `coinmc_rapier` in time steps; [`coinmc_core`] holds what they share.
//!
//! # Cargo features
//! * `parquet` (default): tables as Parquet. Without it a run directory has no
//!   `results.parquet`.
//! * `rapier`: the engine `[engine.rapier]`. Without it such a config is rejected.

pub mod config;
pub mod engines;
mod on_demand;
pub mod plan;
pub mod published;
pub mod results;
pub mod run;

pub use on_demand::OnDemand;

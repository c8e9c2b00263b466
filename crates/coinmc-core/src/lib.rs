#![doc = include_str!("../README.md")]
//!
//! # How the types fit together
//! A [`Coin`] is tossed onto a [`Surface`] (together with gravity: a [`Scene`]). A
//! [`LaunchDistribution`] turns uniform random numbers into a [`Launch`]; an [`Engine`] turns a
//! launch into an [`Outcome`]; a [`Tally`] counts outcomes; an [`Estimate`] is a probability with
//! its interval.
//!
//! ```text
//! Stream ──uniforms──▶ LaunchDistribution ──Launch──▶ Engine ──Outcome──▶ Tally ──▶ Estimate
//! (seed, point, toss)                                    │
//!                                                    Observer (events; `()` costs nothing)
//! ```
//!
//! # Conventions
//! * SI units and `f64` throughout; public names carry their unit (`radius_m`, `spin_rad_s`).
//! * *ratio* always means H/R, height over **radius**.
//! * z points up, the surface is the plane z = 0. A flat toss lives in the xz plane and turns
//!   about y.
//! * +u is the outward normal of the heads face, and the outcome *heads* means that heads
//!   **shows** at rest (u points up), as in everyday speech: the coin lies on its tails face.

mod batch;
mod beta;
mod body;
mod coin;
mod contact_patch;
mod csv;
mod decision;
mod descriptor;
mod dyn_engine;
mod engine;
mod estimate;
mod launch;
mod lower_rim;
mod material;
mod observer;
mod outcome;
mod random;
mod roughness;
mod scene;
pub mod schema;
mod side_ending;
mod surface;
mod tally;
#[cfg(test)]
mod testing;
mod tilt;

pub use batch::TossBatch;
pub use body::{Body, Units};
pub use coin::{Coin, CoinError, Rim};
pub use coinmc_lanes::Lanes;
pub use contact_patch::{hertz_radius_m, pivoting_friction_of_patch_m};
pub use csv::csv_cell;
pub use decision::{Decided, DecisionRule, DecisionState};
pub use descriptor::{
    Answer, EngineChoice, EngineDescriptor, EngineError, EngineKind, EngineSettings, Finer,
    LawDescriptor, LawSettings, Remark, Unmodelled,
};
pub use dyn_engine::DynEngine;
pub use engine::{Engine, Event, EventKind, OutcomeSink, State, run_tosses, toss_sequential};
pub use estimate::{
    Estimate, IntervalMethod, relative_error, rule_of_thumb_relative_error, student_t_quantile,
};
pub use launch::{
    Launch, LaunchDistribution, LaunchError, LaunchSource, Launches, Marginal, Orientation, Preset,
    Spin, Starts, inverse_normal_cdf,
};
pub use lower_rim::LowerRim;
pub use material::{Material, Sourced};
pub use observer::{DynObserver, Observer, sample_between};
pub use outcome::{Breaks, Ended, Face, Outcome};
pub use random::{Domain, Philox4x64, Stream, TossUniforms, UniformSource, unit_interval};
pub use roughness::{Roughness, RoughnessError};
pub use scene::{Drag, Scene, SceneParameter};
pub use side_ending::{OntoSide, ROLL_BOUNDS_M, SideEnding, SideMotion};
pub use surface::{Landing, Surface, SurfaceError};
pub use tally::{Counter, CounterKind, Tally};
pub use tilt::{TableTilt, TableTiltError};

/// The code of the walk-through is tested.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/developer/add-an-engine.md")]
mod add_an_engine {}

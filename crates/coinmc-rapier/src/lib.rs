#![doc = include_str!("../README.md")]
//!
//! # Model
//! Rapier makes the steps at the surface. This crate gives it a half-space and cylinders, in units in
//! which every coin has the same size. It computes free flight in closed form, ends a toss when its
//! face is decided ([`coinmc_core::DecisionRule`]), and counts what goes wrong. What Rapier gets wrong
//! for a coin, and below which step that no longer matters, is measured in `docs/methods/rapier.md`.
//!
//! # Range
//! Any ratio and moments of inertia, restitution, friction, restitution threshold and drag, with or
//! without gyroscopic torque; rolling and pivoting friction as torques between Rapier's steps. A toss
//! ends as [`coinmc_core::Ended::Failed`], with the [`Flaw`] in its [`Account`], if the coin tunnels
//! through the plane, is sunk in it when its face is decided, gains energy or has a value that is NaN
//! or infinite. Without the feature `rapier` (on by default) the crate has the settings alone and
//! rejects every scene.
//!
//! # Files
//! `settings` the user's choices · `scaled` the scene in the engine's units · `motion` how a coin
//! moves · `flight` free flight in closed form, and how far it is proven to be free of contact ·
//! `world` Rapier · `rolling_friction` rolling and pivoting friction · `standing` a coin that stands
//! and spins · `rest` coming to rest · `toss` one toss and its observer · `driver` what happens to a
//! toss between steps · `batch` many tosses in one world · `engine` the public engine · `account` the
//! account of a toss.

// The settings alone are useful too: to read a config that this build cannot run.
#![cfg_attr(not(feature = "rapier"), allow(dead_code))]

mod account;
mod batch;
mod descriptor;
mod driver;
mod engine;
mod flight;
mod motion;
mod rest;
mod rolling_friction;
mod scaled;
mod settings;
mod standing;
mod toss;
mod world;

pub use account::{Account, Flaw};
pub use descriptor::ENGINE;
pub use engine::{RapierEngine, Workspace};
pub use settings::{
    Decision, Flight, FrictionModel, Gyroscopic, Settings, SettingsError, Standing,
};

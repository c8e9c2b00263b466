#![doc = include_str!("../README.md")]
//!
//! # Model
//! Rapier makes the steps at the surface. This crate gives it a half-space and one cylinder in a
//! frame in which every coin has the same size, computes free flight in closed form, ends a toss when
//! energy has settled its face, and counts what goes wrong. What Rapier gets wrong for a coin, and at
//! which step that stops to matter, was measured: `docs/methods/rapier.md`.
//!
//! # Range
//! Any ratio and moments of inertia, restitution, friction, restitution threshold, drag, with or
//! without gyroscopic torque; friction against rolling and pivoting as torques between Rapier's
//! steps. A coin that tunnels through the plane, is sunk in it when its face is settled, gains energy
//! or is no longer a number ends as [`coinmc_core::Ended::Failed`], with the [`Flaw`] in its
//! [`Account`]. Without the feature `rapier` (on by default) the crate has the settings alone and
//! rejects every scene.
//!
//! # Files
//! `settings` choices · `body` shape and frame · `motion` state · `flight` closed form, and how far it
//! is proven free of contact · `world` Rapier · `resist` friction against rolling and pivoting ·
//! `standing` a coin that stands and spins · `verdict` when the face is settled · `toss` one toss and
//! its observer · `rules` what is done before and after a step · `batch` one toss, and several in one
//! world · `engine` what others see of it · `account` what a toss came to.

// The settings alone are useful too: to read a config that this build cannot run.
#![cfg_attr(not(feature = "rapier"), allow(dead_code))]

mod account;
mod batch;
mod body;
mod engine;
mod flight;
mod motion;
mod resist;
mod rules;
mod settings;
mod standing;
mod toss;
mod verdict;
mod world;

pub use account::{Account, Flaw};
pub use engine::{RapierEngine, Workspace};
pub use settings::{
    Decision, Flight, FrictionModel, Gyroscopic, Settings, SettingsError, Standing,
};

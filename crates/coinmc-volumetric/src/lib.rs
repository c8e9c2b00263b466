#![doc = include_str!("../README.md")]
//!
//! # Model
//! The coin flies in closed form to the first root of its gap, which is never missed, and is thrown
//! back by an [`ImpactLaw`]. When the remaining bounces would be over before it has turned
//! noticeably it goes on in sustained contact: on one point of a rim, sticking or sliding, with
//! friction against rolling and pivoting, or along its side. The toss ends when the energy that
//! can still tilt the coin is too small to carry it over its rim. Derivations: `docs/methods/space.md`.
//!
//! # Range
//! Any ratio and moments of inertia, restitution 0 to 1, any friction and friction lengths, linear
//! drag, with or without gyroscopic torque. Rigid bodies: elastic compliance and the flow of air
//! are not modelled. What is never lost is never decided: a coin that passes from well to well for
//! ever (e = 1 without friction, rolling without friction lengths) ends as
//! [`coinmc_core::Ended::NeverSettles`] where that can be told, else at a limit; both are counted.
//!
//! # Files
//! `body` shape, friction, units · `motion` state and frame · `flight` orbit and first contact ·
//! `aloft` the toss in flight · `impact` laws, friction lengths, tangential impact · `contact` on a
//! rim point and on the side · `rest` lying, standing, tripping · `toss` one toss and its place in
//! the laboratory · `strike` one impact · `engine` their order · `batch` many tosses side by side ·
//! `observer_adapter` what an observer is shown of contact · `settings` choices · `series` elementary
//! functions of the kernels. When a face is decided is in [`coinmc_core::DecisionRule`].

mod aloft;
mod any;
mod batch;
mod body;
mod contact;
mod engine;
mod flight;
#[cfg(test)]
mod four;
mod impact;
mod motion;
mod observer_adapter;
mod rest;
mod series;
mod settings;
mod strike;
mod toss;

pub use any::AnyVolumetricEngine;
pub use body::{Body, Friction};
pub use coinmc_lanes::{Lane, Lanes, Mask, NoSuchLanes};
pub use engine::VolumetricEngine;
pub use impact::{
    ChatterjeeRuina, ContactMatrix, ImpactLaw, Impulse, Kick, Moreau, Stronge, Touch,
};
pub use settings::{Decision, Law, Settings, SettingsError};

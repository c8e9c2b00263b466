#![doc = include_str!("../README.md")]
//!
//! # Model
//! The coin flies in closed form to the first root of its gap, which is never missed, and bounces
//! by an [`ImpactLaw`]. When all remaining bounces would be over before the coin has turned
//! noticeably, sustained contact follows: on one point of a rim, sticking or slipping, with
//! friction against rolling and pivoting, or on the side. The toss ends when the energy that can
//! still tilt the coin is too small to carry it over its rim. Derivations: `docs/methods/space.md`.
//!
//! # Range
//! Any ratio and moments of inertia, restitution 0 to 1, any friction and friction lengths, linear
//! drag, with or without gyroscopic torque. The bodies are rigid: elastic compliance and the flow
//! of air are not modelled. Where no energy is lost, some tosses are never decided: a coin that
//! moves from one face or side to another forever (e = 1 without friction, rolling without
//! friction lengths) ends as [`coinmc_core::Ended::NeverSettles`] where that is known, and
//! otherwise at a limit. Both are counted.
//!
//! # Modules
//! Each line uses only the lines above it:
//!
//! - `series` elementary functions · `body`, `drag` the scene in the kernel's units
//! - `impact` impulse at the rim, the trait of impact laws · `laws` a file for each law, and their list ·
//!   `settings` · `limits` · `motion` state and folded frame
//! - `place`, `observer_adapter` what an observer is shown
//! - `flight` the orbit and its first contact · `contact` sustained contact
//! - `toss` the state of one toss · `model` the constants of all tosses · `transition`,
//!   `finished_toss`
//! - `bounce` one impact · `ending` how a toss ends
//! - `rough` rough ground: contact and low hops on a random height field
//! - `flight_phase`, `contact_phase`, `impact_phase` one toss through each phase
//! - `scalar` one toss from launch to end · `batch` many tosses in lanes
//! - `conical` coins with a conical edge: both rims in turn
//! - `slide` the last slide of a flat coin, `table` tosses on a table with an edge
//! - `engine` the public engine · `descriptor` what the rest of the program knows of it
//!
//! The rule that decides a face is [`coinmc_core::DecisionRule`].

mod batch;
mod body;
mod bounce;
mod conical;
mod contact;
mod contact_phase;
mod descriptor;
mod drag;
mod ending;
mod engine;
mod finished_toss;
mod flight;
mod flight_phase;
#[cfg(test)]
mod four;
mod impact;
mod impact_phase;
mod laws;
mod limits;
mod model;
mod motion;
mod observer_adapter;
mod onto_side;
mod place;
mod pull;
mod residue;
mod restitution;
#[cfg(test)]
mod rigid;
mod rough;
mod scalar;
mod series;
mod settings;
mod slide;
mod table;
mod toss;
mod transition;

pub use body::{Body, Friction};
pub use coinmc_lanes::{Lane, Lanes, Mask, NoSuchLanes};
pub use descriptor::ENGINE;
pub use engine::VolumetricEngine;
pub use impact::{ContactMatrix, ContactPoint, ImpactLaw, Impulse, VelocityJump};
pub use laws::{ChatterjeeRuina, Law, Moreau, Stronge};
pub use settings::{Decision, Settings, SettingsError};

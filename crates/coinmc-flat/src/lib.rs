#![doc = include_str!("../README.md")]
//!
//! # Model
//! The coin's section is a rectangle 2R × H with the moment of inertia of the coin about a
//! diameter. It flies in closed form ([`flight`](self)), touches with a corner at the first root
//! of gap(t), which is never missed, and is thrown back by an [`ImpactLaw`]. When the remaining
//! bounces would be over in no time it goes on in sustained contact: pivoting about the corner,
//! sliding or not, flat on an edge, rocking from corner to corner. The toss ends when its energy
//! is below the barrier m g D, D = sqrt(R² + H²/4): from then on no balance over a corner can be
//! crossed and the face is decided.
//!
//! # Range
//! Any ratio, restitution 0 to 1, any friction. Coins are rigid but for [`Law::LineContact`] in its
//! impacts; air and rolling friction are not modelled. Tosses at e = 1 without friction conserve energy and end undecided,
//! at the limit of impacts; they are counted.
//!
//! # Files
//! `shape` geometry · `motion` state · `flight` first contact · `impact_law` the trait of the laws of
//! impact, `laws` a file for each · `contact_matrix` and `touching` what an impulse does ·
//! `dormand_prince` steps in time · `bounce` one impact and what follows it · `pivot` and `slide`
//! contact phases · `contact` their order · `engine` the toss · `batch` many tosses at once · `any` its
//! law chosen at run time · `single` one impact alone · `observer_adapter` what an observer is shown ·
//! `settings` choices.

mod batch;
mod contact;
mod contact_matrix;
mod counters;
mod decision;
mod descriptor;
mod dormand_prince;
mod engine;
mod flight;
mod impact;
mod impact_law;
mod laws;
mod motion;
mod observer_adapter;
mod parameters;
mod pivot;
mod pivot_time;
mod scalar;
mod settings;
mod shape;
mod single;
mod slide;
mod toss;
mod touching;
mod transition;

pub use coinmc_lanes::{Lane, Lanes, NoSuchLanes};
pub use contact_matrix::{ContactMatrix, Impulse};
pub use descriptor::ENGINE;
pub use engine::FlatEngine;
pub use impact_law::{Impact, ImpactLaw, Resolution};
pub use laws::Law;
pub use laws::chatterjee_ruina::ChatterjeeRuina;
pub use laws::gaek_sukhov::{GaekSukhov, GaekSukhovImpact, Lever};
pub use laws::half_sine::{HalfSine, HalfSineImpact, PulseTime};
pub use laws::line_contact::{LineContact, LineContactImpact};
pub use laws::moreau::Moreau;
pub use laws::palmgren::Materials;
pub use settings::{Decision, Settings, SettingsError};
pub use single::SingleImpact;

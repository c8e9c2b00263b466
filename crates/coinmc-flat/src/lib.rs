#![doc = include_str!("../README.md")]
//!
//! # Model
//! The section of the coin is a rectangle 2R × H with the moment of inertia of the coin about a
//! diameter. The coin flies in closed form, touches with a corner at the first root of gap(t),
//! which is never missed, and rebounds by an [`ImpactLaw`]. When the remaining bounces would be
//! very short, they are replaced by sustained contact: the coin pivots about the corner, sliding or
//! sticking, lies flat on an edge, or rocks from corner to corner. The face is decided when the
//! energy is below the barrier m g D, D = sqrt(R² + H²/4): from then on the coin cannot cross a
//! balance over a corner.
//!
//! # Range
//! Any ratio, restitution 0 to 1, any friction. Coins are rigid, except in impacts by
//! [`Law::LineContact`]. Air and rolling friction are not modelled. Tosses at e = 1 without
//! friction conserve energy; they end undecided at the limit of impacts and are counted.
//!
//! # Layers
//! Each module depends only on those above it.
//!
//! | modules | content |
//! |---|---|
//! | `shape`, `motion`, `contact_matrix`, `touching` | geometry, state, effect of an impulse |
//! | `impact_law`, `laws` | what a law of impact is; one file per law |
//! | `settings`, `decision`, `counters` | what a user chooses, when a face is decided |
//! | `flight`, `slide`, `pivot`, `contact` | the phases between impacts |
//! | `parameters`, `toss` | what all tosses of a scene share; the state of one toss |
//! | `impact`, `transition` | an impact; what a toss does next |
//! | `scalar`, `batch` | the drivers: one toss with an observer, many tosses in lanes |
//! | `engine`, `single` | the public engine of one law, single impacts |
//! | `by_law`, `descriptor` | the same for the law that the settings name, and for configs |

mod batch;
mod by_law;
mod contact;
mod contact_matrix;
mod counters;
mod dead_contact;
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
mod settings_error;
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
pub use impact_law::{Impact, ImpactLaw, PlanarLaw, Resolution};
pub use laws::Law;
pub use laws::chatterjee_ruina::ChatterjeeRuina;
pub use laws::gaek_sukhov::{GaekSukhov, GaekSukhovImpact, Lever};
pub use laws::half_sine::{HalfSine, HalfSineImpact, PulseTime};
pub use laws::line_contact::{LineContact, LineContactImpact};
pub use laws::moreau::Moreau;
pub use laws::palmgren::Materials;
pub use settings::{Decision, Settings};
pub use settings_error::SettingsError;
pub use single::SingleImpact;

/// The code of the walk-through is tested.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/developer/add-a-law.md")]
mod add_a_law {}

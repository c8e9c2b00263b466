//! Event-driven toss of a coin in space.

mod body;
mod contact;
mod engine;
mod flight;
mod impact;
mod lane;
mod motion;
mod series;
mod settings;
mod toss;
mod verdict;

pub use body::{Body, Friction};
pub use engine::{AnyVolumetricEngine, VolumetricEngine};
pub use impact::{
    ChatterjeeRuina, ContactMatrix, ImpactLaw, Impulse, Kick, Moreau, Stronge, Touch,
};
pub use lane::{Lane, Mask};
pub use settings::{Decision, Law, Settings, SettingsError};

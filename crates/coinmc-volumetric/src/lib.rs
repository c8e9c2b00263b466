//! Event-driven toss of a coin in space.

mod body;
mod engine;
mod impact;
mod lane;
mod settings;

pub use body::{Body, Friction};
pub use engine::{AnyVolumetricEngine, VolumetricEngine};
pub use impact::{ChatterjeeRuina, ContactMatrix, ImpactLaw, Impulse, Moreau, Stronge, Touch};
pub use lane::{Lane, Mask};
pub use settings::{Decision, Law, Settings, SettingsError};

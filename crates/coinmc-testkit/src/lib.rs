//! What the tests of several packages share. Nothing published depends on it: engines name it as a
//! development dependency by path, without a version, which cargo leaves out of packages.

mod batch;
pub mod conformance;
mod dice;
pub mod durable;
mod hostile;
mod observers;
mod outcomes;
mod scale;
mod scenes;
pub mod study;

pub use batch::{batch_outcomes, count_until, scalar_outcomes};
pub use dice::Dice;
pub use hostile::{is_finite, replace_two, within_two_minutes};
pub use observers::{Extremes, Instants, Recorder, Sampler, samples_beside_events};
pub use outcomes::{counts, paired, side, turned};
pub use scale::Scale;
pub use scenes::{adhesive, hand_at, preset_launch, rolling_scene, scene, stream, table1};

//! Whole tosses onto an explicit rough ground, in fixed steps.

mod decision;
pub(crate) mod rim;
mod start;
mod step;
mod stepper;

pub use decision::Ending;
pub use start::Start;
pub use stepper::{RoughHistory, RoughSettings, RoughStepper};

//! A corner that slides with friction.

mod equations;
mod events;
mod phase;
mod stage;

pub(crate) use events::SlideEnd;
pub(crate) use phase::{SlidePhase, SlideStart};
pub(crate) use stage::SlideStage;

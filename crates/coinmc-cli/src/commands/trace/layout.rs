//! `coinmc trace layout`: how a viewer shows a recording.

use crate::exit::{Failure, Outcome};
use crate::output;
use clap::Args;
use coinmc_trace::LAYOUT;

/// Print a layout with which Lichtblick or Foxglove shows a trace
///
/// Store it as a file and import it in the viewer: the coin in three dimensions, its height and
/// energy over time, its modes and events.
#[derive(Debug, Args)]
pub(super) struct Layout {}

impl Layout {
    #[allow(clippy::unused_self)] // as the other commands
    pub(super) fn execute(&self) -> Result<Outcome, Failure> {
        output::print(LAYOUT).map_err(|error| Failure::Runtime(error.into()))?;
        Ok(Outcome::Done)
    }
}

//! `coinmc schema`: the JSON Schema of configs.

use crate::exit::{Failure, Outcome};
use crate::output;
use clap::Args;

/// Print the JSON Schema of configs
///
/// Editors with a TOML language server complete and check configs with it.
#[derive(Debug, Args)]
pub(crate) struct Schema {}

impl Schema {
    #[allow(clippy::unused_self)] // every verb has the same shape
    pub(crate) fn execute(&self) -> Result<Outcome, Failure> {
        let schema = coinmc::config::json_schema();
        let text = format!("{}\n", schema.trim_end());
        output::print(&text).map_err(|error| Failure::Runtime(error.into()))?;
        Ok(Outcome::Done)
    }
}

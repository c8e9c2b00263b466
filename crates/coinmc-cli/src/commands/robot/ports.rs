//! `coinmc robot ports`: the list of serial ports.

use crate::exit::{Failure, Outcome};
use crate::output::{self, Console, FORMAT_VERSION, Format};
use clap::Args;
use coinmc_robot::port::{PortEntry, ports};
use serde_json::json;

/// List the serial ports of this machine
///
/// Use a stable name (marked `stable`): it belongs to the robot whichever socket it is plugged
/// into.
#[derive(Debug, Args)]
pub(super) struct Ports {
    /// Format of the list
    #[arg(long, value_enum, default_value_t = Format::Table)]
    pub(super) format: Format,
}

impl Ports {
    pub(super) fn execute(console: &Console) -> Result<Outcome, Failure> {
        let found = ports().map_err(|error| Failure::Runtime(error.into()))?;
        match console.format() {
            Format::Json => output::print_json(&json!({
                "format_version": FORMAT_VERSION,
                "kind": "robot-ports",
                "ports": found.iter().map(|entry| json!({
                    "path": entry.path.to_string_lossy(),
                    "device": entry.device.to_string_lossy(),
                    "stable": entry.stable,
                })).collect::<Vec<_>>(),
            })),
            Format::Table => output::print(&found.iter().map(line).collect::<String>()),
        }
        .map_err(|error| Failure::Runtime(error.into()))?;
        if found.is_empty() {
            output::note("no serial ports: is the robot plugged in?");
        }
        Ok(Outcome::Done)
    }
}

fn line(entry: &PortEntry) -> String {
    let path = entry.path.display();
    if entry.stable {
        format!("{path}  stable, now {}\n", entry.device.display())
    } else {
        format!("{path}\n")
    }
}

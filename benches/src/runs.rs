//! Runs of the program's runner, in temporary directories.

use anyhow::{Context, anyhow};
use coinmc::config;
use coinmc::plan::Plan;
use coinmc::run::{Options, Part, Report, run};
use std::num::NonZeroUsize;
use std::sync::atomic::AtomicBool;

/// The plan of a config.
///
/// # Errors
/// If the config is not valid; the message shows where.
pub fn plan(text: &str) -> anyhow::Result<Plan> {
    config::parse("study", text, &[]).map_err(|problems| anyhow!("{}", problems.render(false)))
}

/// Runs a plan in a directory that is deleted afterwards. `None`: one thread per core.
///
/// # Errors
/// If the run fails or no directory can be made.
pub fn run_once(plan: &Plan, threads: Option<NonZeroUsize>) -> anyhow::Result<Report> {
    let directory = tempfile::tempdir().context("no directory for the run")?;
    let options = Options {
        out: directory.path(),
        build: env!("CARGO_PKG_VERSION"),
        part: Part::WHOLE,
        threads,
        cancel: &AtomicBool::new(false),
        sink: &(),
    };
    Ok(run(plan, &options)?)
}

//! Runs of the whole program's runner, in a directory that lasts as long as they do.

use anyhow::{Context, anyhow};
use coinmc::config;
use coinmc::plan::Plan;
use coinmc::run::{Options, Part, Report, run};
use std::num::NonZeroUsize;
use std::sync::atomic::AtomicBool;

/// The plan of a config.
pub(crate) fn plan(text: &str) -> anyhow::Result<Plan> {
    config::parse("study", text, &[]).map_err(|problems| anyhow!("{}", problems.render(false)))
}

/// Runs a plan in a directory that is deleted afterwards. `None`: a thread a core.
pub(crate) fn run_once(plan: &Plan, threads: Option<NonZeroUsize>) -> anyhow::Result<Report> {
    let directory = tempfile::tempdir().context("no directory for the run")?;
    let options = Options {
        out: directory.path(),
        part: Part::WHOLE,
        threads,
        cancel: &AtomicBool::new(false),
        sink: &(),
    };
    Ok(run(plan, &options)?)
}

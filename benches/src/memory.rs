//! Peak memory of a run, measured in a process of its own.

use crate::run_once::{plan, run_once};
use anyhow::{Context, anyhow};
use clap::Args;
use std::io::{self, Write};
use std::process::Command;

/// A run whose first contact decides: the quickest toss there is.
#[derive(Debug, Args)]
pub(crate) struct Run {
    #[arg(long, value_parser = crate::number::count)]
    tosses: u64,
}

impl Run {
    /// Runs and prints the process's peak memory in kB.
    pub(crate) fn carry_out(&self) -> anyhow::Result<()> {
        let plan = plan(&format!(
            "coin.ratio = 1.2\nsurface.landing = 'adhesive'\nlaunch.preset = 'robot'\n\
             engine.flat.law = 'moreau'\nstop.tosses = {}\n",
            self.tosses
        ))?;
        run_once(&plan, None)?;
        let peak = own_peak_kb().context("the peak memory is known on Linux only")?;
        writeln!(io::stdout(), "{peak}")?;
        Ok(())
    }
}

/// Peak memory, kB, of a process that runs so many tosses.
pub(crate) fn peak_kb(tosses: u64) -> anyhow::Result<f64> {
    let program = std::env::current_exe().context("this program cannot find itself")?;
    let output = Command::new(program)
        .args(["memory", "--tosses", &tosses.to_string()])
        .output()
        .context("this program cannot be started again")?;
    if !output.status.success() {
        let message = String::from_utf8_lossy(&output.stderr);
        return Err(anyhow!(
            "a run of {tosses} tosses failed: {}",
            message.trim()
        ));
    }
    let text = String::from_utf8(output.stdout)?;
    Ok(text.trim().parse()?)
}

/// High-water mark of this process's resident memory.
fn own_peak_kb() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.trim().strip_suffix("kB")?.trim().parse().ok()
}

//! A run in a process of its own: how long it took, and its peak memory.

use anyhow::{Context, anyhow, bail};
use clap::{Args, ValueEnum};
use coinmc_bench::number;
use coinmc_bench::runs::{plan, run_once};
use std::io::{self, Write};
use std::num::NonZeroUsize;
use std::process::Command;
use std::time::Instant;

/// What is tossed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Toss {
    /// In the plane, H/R = 1.2, e = .5, without friction
    Flat,
    /// In space, H/R = .85, e = .5, μ = .3, ρ/R = .01
    Space,
}

/// The run.
#[derive(Debug, Clone, Copy, Args)]
pub(crate) struct RunApart {
    #[arg(long, value_enum)]
    pub(crate) toss: Toss,
    #[arg(long, value_parser = number::count)]
    pub(crate) tosses: u64,
    /// A thread a core without it
    #[arg(long)]
    pub(crate) threads: Option<NonZeroUsize>,
}

/// What the run took.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Taken {
    pub(crate) wall_s: f64,
    /// On all processors together.
    pub(crate) processor_s: f64,
    pub(crate) peak_kb: f64,
}

impl Toss {
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Flat => "flat",
            Self::Space => "space",
        }
    }

    fn config(self, tosses: u64) -> String {
        let scene = match self {
            Self::Flat => {
                "coin = { ratio = 1.2, radius_m = 0.01 }\n\
                 surface = { restitution = 0.5, friction = 0.0 }\n\
                 launch.preset = 'clean-flat'\nengine.flat.law = 'moreau'"
            }
            Self::Space => {
                "coin = { ratio = 0.85, radius_m = 0.01 }\n\
                 surface = { restitution = 0.5, friction = 0.3, rolling_friction_m = 1e-4, pivoting_friction_m = 1e-4 }\n\
                 launch.preset = 'clean'\nengine.volumetric.law = 'moreau'"
            }
        };
        format!("{scene}\nstop.tosses = {tosses}\n")
    }
}

impl RunApart {
    /// Makes the run in this process and prints what it took.
    pub(crate) fn execute(&self) -> anyhow::Result<()> {
        let plan = plan(&self.toss.config(self.tosses))?;
        let start = Instant::now();
        run_once(&plan, self.threads)?;
        let wall = start.elapsed().as_secs_f64();
        let processor = processor_s().context("processor time is known on Unix only")?;
        let peak = own_peak_kb().context("the peak memory is known on Linux only")?;
        writeln!(io::stdout(), "{wall} {processor} {peak}")?;
        Ok(())
    }

    /// Makes the run in another process.
    pub(crate) fn measure(&self) -> anyhow::Result<Taken> {
        let program = std::env::current_exe().context("this program cannot find itself")?;
        let mut command = Command::new(program);
        command.args(["run-apart", "--toss", self.toss.name()]);
        command.args(["--tosses", &self.tosses.to_string()]);
        if let Some(threads) = self.threads {
            command.args(["--threads", &threads.to_string()]);
        }
        let output = command.output();
        let output = output.context("this program cannot be started again")?;
        if !output.status.success() {
            let message = String::from_utf8_lossy(&output.stderr);
            bail!("a run of {} tosses failed: {}", self.tosses, message.trim());
        }
        let text = String::from_utf8(output.stdout)?;
        let numbers: Result<Vec<f64>, _> = text.split_whitespace().map(str::parse).collect();
        match numbers?[..] {
            [wall_s, processor_s, peak_kb] => Ok(Taken {
                wall_s,
                processor_s,
                peak_kb,
            }),
            _ => Err(anyhow!("a run said `{}`", text.trim())),
        }
    }
}

/// What this process has had of all processors.
#[cfg(unix)]
fn processor_s() -> Option<f64> {
    use rustix::time::{ClockId, clock_gettime};
    let spent = std::time::Duration::try_from(clock_gettime(ClockId::ProcessCPUTime));
    spent.ok().map(|spent| spent.as_secs_f64())
}

#[cfg(not(unix))]
fn processor_s() -> Option<f64> {
    None
}

/// High-water mark of this process's resident memory.
fn own_peak_kb() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.trim().strip_suffix("kB")?.trim().parse().ok()
}

//! `coinmc trace`: tosses seen again.

mod files;
mod recover;
mod report;
mod select;

use crate::exit::{Failure, Outcome};
use crate::interrupt;
use crate::output::{Console, Format};
use crate::terminal::progress::Progress;
use anyhow::{Context, anyhow};
use clap::{ArgGroup, Args, Subcommand};
use coinmc::config::{self, Override};
use coinmc::plan::Plan;
use coinmc::run::stored_plan;
use coinmc_recording::Compression;
use coinmc_trace::replay_within;
use coinmc_trace::{Condition, Length, MAX_RECORDS, Trace as Recorded, default_rate_hz, launch};
use files::Files;
use recover::Recover;
use select::{Selected, Status};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

const EXAMPLES: &str = "\
Examples:
  coinmc trace examples/flat-fair.toml --toss 42 --show              what happened, event by event
  coinmc trace toss.toml --point 3 --toss 0,1,2 -o tosses.mcap       for a viewer of MCAP
  coinmc trace runs/first --where face=side --count 3 -o sides.csv   the first three on the side
  coinmc trace toss.toml --longest --rate 2000 -o long.parquet -o long.svg
  coinmc trace recover torn.mcap                                     what a crash has left";

/// Records of all traces of a file, at most: some 300 MB of memory.
const MOST_RECORDS: usize = 2_000_000;

/// Replay tosses, bit for bit, and show or record them
///
/// Nothing of a toss needs to have been stored: its point and number say which random numbers it
/// began with. Files are MCAP, CSV, Parquet, JSON lines or SVG, told by the name's ending.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES, args_conflicts_with_subcommands = true)]
#[command(subcommand_negates_reqs = true)]
#[command(group(
    ArgGroup::new("which").required(true).multiple(true).args(["tosses", "conditions", "longest"])
))]
pub(crate) struct Trace {
    #[command(subcommand)]
    recover: Option<Verb>,

    /// The config (TOML), or the directory of a run
    #[arg(required = true, value_name = "CONFIG|RUN_DIR")]
    config: Option<PathBuf>,

    /// Points, by their index from 0; several with commas
    /// [default: with --toss the first, else all]
    #[arg(long = "point", value_name = "P", value_delimiter = ',')]
    points: Vec<usize>,

    /// Tosses of each point, by their number from 0; several with commas
    #[arg(long = "toss", value_name = "K", value_delimiter = ',')]
    #[arg(conflicts_with_all = ["conditions", "longest", "count", "limit"])]
    tosses: Vec<u64>,

    /// Search for tosses that went so: face=side, ended=time_limit, …; repeat to ask for both
    #[arg(long = "where", value_name = "WHAT=HOW")]
    conditions: Vec<Condition>,

    /// Search for the longest toss, in simulated time or in impacts
    #[arg(long, value_name = "BY", num_args = 0..=1, require_equals = true)]
    #[arg(default_missing_value = "time", value_enum)]
    longest: Option<By>,

    /// How many tosses to search for
    #[arg(long, value_name = "N", default_value_t = 1)]
    #[arg(value_parser = clap::value_parser!(u16).range(1..=1000))]
    count: u16,

    /// Tosses to look at in a search, at most, point by point and in order
    #[arg(long, value_name = "N", default_value_t = 100_000)]
    limit: u64,

    /// Samples a second between events; 0 for events alone
    /// [default: 24 a turn and 20 a topple, rounded up to 1, 2 or 5]
    #[arg(long, value_name = "HZ")]
    rate: Option<f64>,

    /// New file to write: .mcap, .csv, .parquet, .jsonl or .svg; repeatable
    #[arg(short, long = "out", value_name = "FILE")]
    outs: Vec<PathBuf>,

    /// Print the events of each toss, and what decided it
    #[arg(long)]
    show: bool,

    /// With --show: every event, also where many small ones follow each other
    #[arg(long, requires = "show")]
    all: bool,

    /// Compression of .mcap files: none or lz4
    #[arg(long, value_name = "HOW", default_value_t = Compression::None)]
    compression: Compression,

    /// Replace or add a value of the config, as in `surface.friction=0.2`; repeatable
    #[arg(long = "set", value_name = "KEY=VALUE")]
    overrides: Vec<Override>,

    /// How to write the result
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,

    /// No progress and no remarks; warnings and errors stay
    #[arg(long, short)]
    quiet: bool,
}

#[derive(Debug, Subcommand)]
enum Verb {
    Recover(Recover),
}

/// What makes a toss long.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum By {
    /// Simulated time
    Time,
    /// Number of impacts
    Impacts,
}

impl Trace {
    pub(crate) fn format(&self) -> Format {
        match &self.recover {
            Some(Verb::Recover(recover)) => recover.format(),
            None => self.format,
        }
    }

    pub(crate) fn execute(&self, console: &Console) -> Result<Outcome, Failure> {
        match (&self.recover, &self.config) {
            (Some(Verb::Recover(recover)), _) => recover.execute(console),
            (None, Some(config)) => self.trace(config, console),
            (None, None) => Err(Failure::Input(anyhow!("name a config or a run directory"))),
        }
    }

    fn trace(&self, config: &Path, console: &Console) -> Result<Outcome, Failure> {
        if self.show && self.format == Format::Json {
            let both =
                anyhow!("--show prints for people and --format json for programs: choose one");
            return Err(Failure::Input(both));
        }
        let plan = self.plan(config)?;
        let progress = Progress::new(*console.stderr(), self.quiet);
        if !self.quiet {
            plan.notes
                .iter()
                .for_each(|note| progress.note(&format!("note: {note}")));
        }
        // before anything takes time
        select::check(self, &plan)?;
        let files = Files::begin(&self.outs, self.most(&plan))?;
        let told = progress.clone();
        let cancel = interrupt::listen(move || told.note("stopping; Ctrl-C again stops at once"))
            .context("cannot listen for signals")
            .map_err(Failure::Runtime)?;
        let selected = select::select(self, &plan, cancel, &progress);
        progress.finish();
        let mut selected = selected?;
        let traces = self.replay(&plan, &mut selected, cancel)?;
        let files = if traces.is_empty() || selected.status == Status::Interrupted {
            Vec::new()
        } else {
            files.write(&plan, &traces, self.compression)?
        };
        report::present(self, &plan, &selected, &traces, &files, console)
    }

    fn plan(&self, config: &Path) -> Result<Plan, Failure> {
        if !config.is_dir() {
            return Ok(config::load(config, &self.overrides)?);
        }
        if !self.overrides.is_empty() {
            return Err(Failure::Input(anyhow!(
                "{} is the run of one config: use --set with a config, such as the config.toml in it",
                config.display()
            )));
        }
        Ok(stored_plan(config)?)
    }

    /// Tosses that will be traced, at most.
    fn most(&self, plan: &Plan) -> usize {
        match self.tosses.len() {
            0 => usize::from(self.count),
            tosses => tosses * select::points(self, plan).len(),
        }
    }

    fn replay(
        &self,
        plan: &Plan,
        selected: &mut Selected,
        cancel: &AtomicBool,
    ) -> Result<Vec<Recorded>, Failure> {
        let most = MAX_RECORDS.min(MOST_RECORDS / selected.tosses.len().max(1));
        let mut traces = Vec::with_capacity(selected.tosses.len());
        for &(point, toss) in &selected.tosses {
            if cancel.load(Ordering::Relaxed) {
                selected.status = Status::Interrupted;
                break;
            }
            let rate = match self.rate {
                Some(rate) => rate,
                None => default_rate_hz(&plan.points[point].scene, &launch(plan, point, toss)?),
            };
            traces.push(replay_within(plan, point, toss, rate, most)?);
        }
        Ok(traces)
    }
}

impl From<By> for Length {
    fn from(by: By) -> Self {
        match by {
            By::Time => Self::Time,
            By::Impacts => Self::Impacts,
        }
    }
}

//! `coinmc trace`: replaying tosses.

mod files;
mod layout;
mod map;
mod recover;
mod report;
mod select;

use crate::exit::{Failure, Outcome};
use crate::interrupt;
use crate::output::{Console, Format};
use crate::terminal::progress::Progress;
use anyhow::anyhow;
use clap::{ArgGroup, Args, Subcommand};
use coinmc::config::{self, Override};
use coinmc::plan::Plan;
use coinmc::run::stored_plan;
use coinmc_recording::{Compression, Encoding};
use coinmc_trace::replay_within;
use coinmc_trace::{Condition, Length, MAX_RECORDS, Trace as Recorded, default_rate_hz, launch};
use files::Files;
use layout::Layout;
use map::MapOf;
use recover::Recover;
use select::{Selected, Status};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

const EXAMPLES: &str = "\
Examples:
  coinmc trace examples/flat-fair.toml --toss 42 --show              what happened, event by event
  coinmc trace toss.toml --point 3 --toss 0,1,2 -o tosses.mcap       for a viewer of MCAP
  coinmc trace layout > layout.json                                  … which shows it like this
  coinmc trace runs/first --where face=side --count 3 -o sides.csv   the first three on the side
  coinmc trace toss.toml --longest --rate 2000 -o long.parquet -o long.svg
  coinmc trace toss.toml --toss 42 -o toss.html                      to turn about in a browser
  coinmc trace map toss.toml --over wy_rad_s=0..60 --over height_m=0.1..1 -o map.html
  coinmc trace recover torn.mcap                                     what a crash has left";

/// Greatest number of records of all traces together, about 300 MB of memory.
const MAX_TOTAL_RECORDS: usize = 2_000_000;

/// Replay tosses exactly, and show or record them
///
/// Tosses need not have been stored: the point and the number of a toss determine its random
/// numbers. Files are MCAP, CSV, Parquet, JSON lines, SVG
/// or HTML (a page with the tosses in three dimensions), by the name's extension.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES, args_conflicts_with_subcommands = true)]
#[command(subcommand_negates_reqs = true)]
#[command(group(
    ArgGroup::new("which").required(true).multiple(true).args(["tosses", "conditions", "longest"])
))]
pub(crate) struct Trace {
    #[command(subcommand)]
    verb: Option<Verb>,

    /// The config (TOML), or the directory of a run
    #[arg(required = true, value_name = "CONFIG|RUN_DIR")]
    config: Option<PathBuf>,

    /// Points, by their index from 0, separated by commas
    /// [default: the first with --toss, otherwise all]
    #[arg(long = "point", value_name = "P", value_delimiter = ',')]
    points: Vec<usize>,

    /// Tosses of each point, by their number from 0, separated by commas
    #[arg(long = "toss", value_name = "K", value_delimiter = ',', value_parser = super::count)]
    #[arg(conflicts_with_all = ["conditions", "longest", "count", "limit"])]
    tosses: Vec<u64>,

    /// Search for tosses with this outcome: face=side, ended=time_limit, …; repeat to require
    /// several
    #[arg(long = "where", value_name = "WHAT=HOW")]
    conditions: Vec<Condition>,

    /// Search for the longest toss, in simulated time or in impacts
    #[arg(long, value_name = "BY", num_args = 0..=1, require_equals = true)]
    #[arg(default_missing_value = "time", value_enum)]
    longest: Option<By>,

    /// Number of tosses to find
    #[arg(long, value_name = "N", default_value_t = 1)]
    #[arg(value_parser = clap::value_parser!(u16).range(1..=1000))]
    count: u16,

    /// Greatest number of tosses to search, point by point and in order
    #[arg(long, value_name = "N", default_value = "100_000", value_parser = super::count)]
    limit: u64,

    /// Samples per second between events; 0 for events only
    /// [default: 24 per turn and 20 per toppling time, rounded up to 1, 2 or 5 times a power of ten]
    #[arg(long, value_name = "HZ")]
    rate: Option<f64>,

    /// New file to write: .mcap, .csv, .parquet, .jsonl, .svg or .html; repeatable
    #[arg(short, long = "out", value_name = "FILE")]
    outs: Vec<PathBuf>,

    /// Print the events of each toss and what decided it
    #[arg(long)]
    show: bool,

    /// With --show: print every event, even if there are many small ones
    #[arg(long, requires = "show")]
    all: bool,

    /// Encoding of the messages in .mcap files: protobuf or json [default: protobuf]
    #[arg(long, value_name = "HOW")]
    encoding: Option<Encoding>,

    /// Compression of .mcap files: none or lz4 [default: none]
    #[arg(long, value_name = "HOW")]
    compression: Option<Compression>,

    /// Replace or add a value of the config, as in `surface.friction=0.2`; repeatable
    #[arg(long = "set", value_name = "KEY=VALUE")]
    overrides: Vec<Override>,

    /// Format of the result
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,

    /// Hide progress and notes; warnings and errors are still shown
    #[arg(long, short)]
    quiet: bool,
}

#[derive(Debug, Subcommand)]
enum Verb {
    Map(MapOf),
    Recover(Recover),
    Layout(Layout),
}

/// The measure of a toss's length.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum By {
    /// Simulated time
    Time,
    /// Number of impacts
    Impacts,
}

impl Trace {
    pub(crate) fn format(&self) -> Format {
        match &self.verb {
            Some(Verb::Map(map)) => map.format(),
            Some(Verb::Recover(recover)) => recover.format(),
            Some(Verb::Layout(_)) => Format::Table,
            None => self.format,
        }
    }

    pub(crate) fn execute(&self, console: &Console) -> Result<Outcome, Failure> {
        match (&self.verb, &self.config) {
            (Some(Verb::Map(map)), _) => map.execute(console),
            (Some(Verb::Recover(recover)), _) => recover.execute(console),
            (Some(Verb::Layout(layout)), _) => layout.execute(),
            (None, Some(config)) => self.trace(config, console),
            (None, None) => Err(Failure::Input(anyhow!("give a config or a run directory"))),
        }
    }

    fn trace(&self, config: &Path, console: &Console) -> Result<Outcome, Failure> {
        if self.show && self.format == Format::Json {
            let both = anyhow!("--show prints text and --format json prints JSON: choose one");
            return Err(Failure::Input(both));
        }
        self.check_options_of_mcap()?;
        let plan = plan_of(config, &self.overrides)?;
        let progress = Progress::new(*console.stderr(), self.quiet);
        if !self.quiet {
            plan.notes
                .iter()
                .for_each(|note| progress.note(&format!("note: {note}")));
        }
        // before the work begins
        select::check(self, &plan)?;
        let files = Files::begin(&self.outs, self.max_traces(&plan))?;
        let for_handler = progress.clone();
        let cancel =
            interrupt::listen(move || for_handler.note("stopping; Ctrl-C again stops at once"))?;
        let selected = select::select(self, &plan, cancel, &progress);
        progress.finish();
        let mut selected = selected?;
        let traces = self.replay(&plan, &mut selected, cancel)?;
        let files = if traces.is_empty() || selected.status == Status::Interrupted {
            Vec::new()
        } else {
            let encoding = self.encoding.unwrap_or_default();
            let compression = self.compression.unwrap_or(Compression::None);
            files.write(&plan, &traces, encoding, compression)?
        };
        report::present(self, &plan, &selected, &traces, &files, console)
    }

    /// That there is a file that the options of MCAP are about.
    fn check_options_of_mcap(&self) -> Result<(), Failure> {
        if self.outs.iter().any(|out| files::is_mcap(out)) {
            return Ok(());
        }
        let given = [
            self.encoding.map(|_| "--encoding"),
            self.compression.map(|_| "--compression"),
        ];
        let given: Vec<&str> = given.into_iter().flatten().collect();
        if given.is_empty() {
            return Ok(());
        }
        let of = if given.len() == 1 { "is" } else { "are" };
        Err(Failure::Input(anyhow!(
            "{} {of} of .mcap files: add one, as in `-o tosses.mcap`",
            given.join(" and ")
        )))
    }

    /// Greatest number of tosses that will be traced.
    fn max_traces(&self, plan: &Plan) -> usize {
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
        let most = MAX_RECORDS.min(MAX_TOTAL_RECORDS / selected.tosses.len().max(1));
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

/// The plan of a config, or of a run directory.
fn plan_of(config: &Path, overrides: &[Override]) -> Result<Plan, Failure> {
    if !config.is_dir() {
        return Ok(config::load(config, overrides)?);
    }
    if !overrides.is_empty() {
        return Err(Failure::Input(anyhow!(
            "{} is the run of a fixed config: use --set with a config, such as the config.toml in it",
            config.display()
        )));
    }
    Ok(stored_plan(config)?)
}

impl From<By> for Length {
    fn from(by: By) -> Self {
        match by {
            By::Time => Self::Time,
            By::Impacts => Self::Impacts,
        }
    }
}

//! `coinmc run`: from a config to probabilities.

use super::new_file::must_end_in;
use super::page::{Page, Replaceable};
use crate::command_line::this_command;
use crate::exit::{Failure, Outcome};
use crate::interrupt;
use crate::output::{self, Console, FORMAT_VERSION, Format, ResultFormat};
use crate::terminal::plot::Plotted;
use crate::terminal::progress::{Progress, with_prefix};
use crate::terminal::summary::{FAIR, markdown, summary};
use crate::terminal::{compact, count, duration, grouped, tosses};
use crate::time_limit::{self, TimeLimit};
use anyhow::anyhow;
use clap::Args;
use coinmc::OnDemand;
use coinmc::config::{self, Override};
use coinmc::plan::{MAX_EVALUATIONS, Plan, StoppedBy};
use coinmc::published::TABLE1_SOURCE;
use coinmc::results::{FairRatio, Row, fair_ratios, write_csv};
use coinmc::run::{Options, Part, Report, Status, stored_plan};
use serde_json::{Map, Value, json};
use std::borrow::Cow;
use std::ffi::OsString;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::time::Duration;

const EXAMPLES: &str = "\
Examples:
  coinmc run examples/flat-fair.toml
  coinmc run toss.toml --set stop.tosses=1e5 --set 'surface.restitution=[0.3, 0.5]'
  coinmc run toss.toml --shard 1/4 --out part-1     one of four machines; see `coinmc merge`
  coinmc run toss.toml --format json > toss.json
  coinmc run toss.toml --report                     and make a page of it, see `coinmc report`

The same command again goes on where the last one stopped, and reports a finished run at once. \
More tosses, a tighter target or more values at the end of the first list go on from there, too.";

/// Toss what a config describes and report probabilities with intervals
///
/// Results go to standard output and, as CSV and Parquet, into the run directory; progress goes to
/// standard error. The counts depend on the config alone, not on threads, parts or interruptions.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Run {
    /// The config (TOML; `coinmc schema` describes it)
    config: PathBuf,

    /// Run directory: new, empty, or that of the same run or one that asked for less
    /// [default: runs/NAME-HASH, from the config's file name and the hash of its meaning]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Do only part I of N of the run
    #[arg(long, value_name = "I/N", default_value_t = Part::WHOLE, hide_default_value = true)]
    shard: Part,

    /// Number of threads [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,

    /// Stop after this time (55min, 1h or 01:30:00), keep what is counted, and exit with status 3
    #[arg(long, value_name = "TIME", value_parser = time_limit::duration)]
    max_time: Option<Duration>,

    /// Replace or add a value of the config, as in `surface.friction=0.2`; repeatable
    #[arg(long = "set", value_name = "KEY=VALUE")]
    overrides: Vec<Override>,

    /// What to plot: a swept parameter, a face, both (`friction,heads`), or `none`
    #[arg(long, value_name = "AXIS,FACE", default_value_t)]
    plot: Plotted,

    /// Also make a page of the run, see `coinmc report` [default: report.html in the run directory]
    #[arg(long, value_name = "FILE", num_args = 0..=1, require_equals = true, default_missing_value = "")]
    report: Option<OsString>,

    /// How to write the result
    #[arg(long, value_enum, default_value_t = ResultFormat::Table)]
    format: ResultFormat,

    /// Show no progress and no remarks, only warnings and errors
    #[arg(long, short)]
    quiet: bool,
}

impl Run {
    pub(crate) fn format(&self) -> Format {
        self.format.of_failures()
    }

    pub(crate) fn execute(&self, console: &Console) -> Result<Outcome, Failure> {
        let plan = config::load(&self.config, &self.overrides)?;
        self.plot.check(&plan.axes).map_err(Failure::Input)?;
        let out = self.out.clone().unwrap_or_else(|| self.default_out(&plan));
        let page = self.page(&plan, &out);
        if let Some((file, replaceable)) = &page {
            replaceable.check(file)?;
            must_end_in(file, "html")?;
            let folder = file.parent().unwrap_or(Path::new(""));
            let is_there = folder == out || folder.as_os_str().is_empty() || folder.is_dir();
            if !is_there {
                return Err(Failure::Input(anyhow!(
                    "--report {}: there is no directory {}",
                    file.display(),
                    folder.display()
                )));
            }
        }
        let progress = Progress::of(&plan, *console.stderr(), self.quiet);
        if !self.quiet {
            plan.notes
                .iter()
                .for_each(|note| progress.note(&format!("note: {note}")));
        }
        let told = progress.clone();
        let cancel =
            interrupt::listen(move || told.note("stopping; press Ctrl-C again to stop at once"))?;
        let limit = self.max_time.map(|time| TimeLimit::start(time, cancel));
        let limit = limit.unwrap_or_default();
        let report = coinmc::run::run(
            &plan,
            &Options {
                out: &out,
                build: coinmc_build::BUILD,
                part: self.shard,
                threads: self.threads.and_then(|n| NonZeroUsize::new(n.into())),
                cancel,
                sink: &progress,
            },
        );
        progress.finish();
        let report = report?;
        if !self.quiet {
            output::note(&closing_line(&report, &progress));
        }
        let made = page
            .map(|(file, replaceable)| make_page(&file, replaceable, &out).map(|()| file))
            .transpose();
        let made = match made {
            // there is one document: the error
            Err(error) if self.format == ResultFormat::Json => return Err(error),
            made => made,
        };
        let stopped = present(&report, &out, &self.plot, console, self.format, self.quiet)?;
        let outcome = if stopped == Outcome::Interrupted && limit.is_reached() {
            Outcome::ShortOfTarget
        } else {
            stopped
        };
        if let Some(file) = made?.filter(|_| !self.quiet) {
            output::note(&format!("Report: {}", file.display()));
        }
        Ok(outcome)
    }

    /// Where the page is to be, if one is asked for, and what it may replace there: in the run directory any page,
    /// and else those of the run and of that from which it goes on.
    fn page(&self, plan: &Plan, out: &Path) -> Option<(PathBuf, Replaceable)> {
        let file = self.report.as_ref()?;
        if file.is_empty() {
            return Some((out.join("report.html"), Replaceable::AnyPage));
        }
        let earlier = stored_plan(out).map(|plan| plan.hash());
        let hashes = [plan.hash()].into_iter().chain(earlier).collect();
        Some((PathBuf::from(file), Replaceable::PageOf(hashes)))
    }

    fn default_out(&self, plan: &Plan) -> PathBuf {
        let stem = self
            .config
            .file_stem()
            .map_or("run".into(), |stem| stem.to_string_lossy());
        let hash = plan.hash();
        let mut name = format!("{stem}-{}", &hash[..8]);
        if self.shard != Part::WHOLE {
            name += &format!("-part-{}-of-{}", self.shard.index(), self.shard.of());
        }
        Path::new("runs").join(name)
    }
}

/// The page of the run, in place of that of an earlier call of the same command.
fn make_page(file: &Path, replaceable: Replaceable, out: &Path) -> Result<(), Failure> {
    let page = Page::begin(file, replaceable)?;
    let run = coinmc_report::Run::open(out, &())?;
    page.write(&coinmc_report::report(
        &[run],
        None,
        &coinmc_report::Samples::default(),
    )?)?;
    Ok(())
}

/// Result on standard output, advice on standard error unless `quiet`.
pub(super) fn present(
    report: &Report,
    out: &Path,
    plotted: &Plotted,
    console: &Console,
    format: ResultFormat,
    quiet: bool,
) -> Result<Outcome, Failure> {
    show(report, out, plotted, console, format)?;
    if let Some(advice) = advice(report, out).filter(|_| !quiet) {
        output::note(&advice);
    }
    Ok(match report.status {
        Status::Complete | Status::Part => Outcome::Done,
        Status::Interrupted => Outcome::Interrupted,
        Status::ShortOfTarget { .. } => Outcome::ShortOfTarget,
    })
}

/// Result on standard output.
pub(super) fn show(
    report: &Report,
    out: &Path,
    plotted: &Plotted,
    console: &Console,
    format: ResultFormat,
) -> Result<(), Failure> {
    let results = &report.results;
    let fair = fair_ratios(results, FAIR);
    match format {
        ResultFormat::Json => output::print_json(&to_json(report, &fair, out)),
        ResultFormat::Table => {
            let csv = csv_in(out, report.status);
            let text = summary(results, &fair, csv.as_deref(), plotted, console.stdout());
            output::print(&text)
        }
        ResultFormat::Csv => output::print_with(|stdout| write_csv(results, stdout)),
        ResultFormat::Markdown => output::print(&markdown(results, console.stdout())),
    }
    .map_err(|error| Failure::Runtime(error.into()))
}

/// The file of the results in a run directory; none where a process was killed before it wrote one.
fn csv_in(out: &Path, status: Status) -> Option<PathBuf> {
    let csv = out.join(match status {
        Status::Complete | Status::ShortOfTarget { .. } => "results.csv",
        Status::Interrupted | Status::Part => "results.partial.csv",
    });
    csv.is_file().then_some(csv)
}

/// What was done, in one line.
fn closing_line(report: &Report, progress: &Progress) -> String {
    let points = count(report.results.rows.len() as u64, "point");
    let mut rows = report.results.rows.each();
    if rows.all(|row| row.interval == "exact") && report.status != Status::Interrupted {
        return format!("coinmc: {points} by closed form, nothing to toss");
    }
    if report.tosses == 0 {
        let evaluations = report.results.rows.each().map(|row| row.evaluations).sum();
        if evaluations > 0 {
            return integrated_line(report, evaluations);
        }
    }
    let (made, time) = progress.made(report.tosses);
    let earlier = report.tosses - made;
    if made == 0 && earlier > 0 && report.status != Status::Interrupted {
        return format!("coinmc: already finished, nothing to toss: {points}");
    }
    let mut line = format!("coinmc: {points}, {} in {}", tosses(made), duration(time));
    if made > 0 {
        line += &format!(" ({}/s)", with_prefix(made as f64 / time.as_secs_f64()));
    }
    if earlier > 0 {
        line += &format!(", {} taken over from an earlier run", grouped(earlier));
    }
    line
}

/// What was done where nothing is tossed.
fn integrated_line(report: &Report, evaluations: u64) -> String {
    let rows = &report.results.rows;
    let points = count(rows.len() as u64, "point");
    let is_done = |row: &Cow<'_, Row>| row.evaluations > 0 || row.interval == "exact";
    let done = rows.each().filter(is_done).count();
    if report.reused_chunks == rows.len() as u64 {
        return format!("coinmc: already finished, nothing to integrate: {points}");
    }
    let points = if done < rows.len() {
        format!("{} of {points}", grouped(done as u64))
    } else {
        points
    };
    let mut line = format!(
        "coinmc: {points} integrated by {}, nothing to toss",
        count(evaluations, "evaluation")
    );
    if report.reused_chunks > 0 {
        let reused = grouped(report.reused_chunks);
        line += &format!(", {reused} reused from an earlier run");
    }
    line
}

/// What is said of a complete part of a run.
pub(super) const PART_IS_COMPLETE: &str = "this part is complete; when all are, merge them with \
     `coinmc merge PART… --out WHOLE`";

/// What the user can do next, if the run is not complete.
fn advice(report: &Report, out: &Path) -> Option<String> {
    match report.status {
        Status::Complete => None,
        Status::Interrupted => Some(format!(
            "coinmc: stopped with {} of {} finished; all counts are kept in {}.\n\
                 Go on with: {}",
            report.points_reached(),
            count(report.results.rows.len() as u64, "point"),
            out.display(),
            this_command()
        )),
        Status::Part => Some(format!("coinmc: {PART_IS_COMPLETE}")),
        Status::ShortOfTarget { .. } => Some(short_of_target(&report.results.rows)),
    }
}

/// What to do about points that stopped short of their targets, by the rule that stopped them.
fn short_of_target(rows: &OnDemand<Row>) -> String {
    let of = |by| rows.each().filter(|row| row.stopped_by == by).count() as u64;
    let mut lines = vec![];
    for (by, key) in [
        (StoppedBy::MaxTosses, "stop.max_tosses"),
        (StoppedBy::MaxCoreSeconds, "stop.max_core_seconds"),
        (StoppedBy::TotalTosses, "the run's stop.total_tosses"),
        (
            StoppedBy::TotalCoreSeconds,
            "the run's stop.total_core_seconds",
        ),
    ] {
        if of(by) > 0 {
            lines.push(format!(
                "coinmc: {} reached {key} before its targets in [stop]: raise it, or ask for less",
                count(of(by), "point"),
            ));
        }
    }
    let hopeless = of(StoppedBy::Undecided);
    if hopeless > 0 {
        let undecided = |row: &Row| {
            let tally = &row.tally;
            tally.undecided() as f64 / tally.tosses().max(1) as f64
        };
        let rows = rows.each();
        let rows = rows.filter(|row| row.stopped_by == StoppedBy::Undecided);
        let most = rows.map(|row| undecided(&row)).fold(0.0, f64::max);
        lines.push(format!(
            "coinmc: {} stopped, as no number of tosses meets the targets: up to {} % of the tosses end without a \
             face, which alone is too much. Let the engine go on longer (see [engine]), or ask for less",
            count(hopeless, "point"),
            compact(libm::round(1e4 * most) / 100.0),
        ));
    }
    let capped = of(StoppedBy::Evaluations);
    if capped > 0 {
        // a limit of its own that no number of tosses raises
        let help = "ask for less, or toss with sampling.method = \"random\"";
        lines.push(format!(
            "coinmc: {} reached the limit of an integral, {} evaluations or max_tosses, before its target \
             in [stop]: {help}",
            count(capped, "point"),
            grouped(MAX_EVALUATIONS),
        ));
    }
    lines.join("\n")
}

/// The document of `--format json`; docs/reference/formats.md describes it.
pub(super) fn to_json(report: &Report, fair: &[FairRatio], out: &Path) -> Value {
    let mut table = report.results.to_json();
    let status = match report.status {
        Status::Complete => "complete",
        Status::Interrupted => "interrupted",
        Status::Part => "part",
        Status::ShortOfTarget { .. } => "short_of_target",
    };
    json!({
        "format_version": FORMAT_VERSION,
        "kind": "run",
        "status": status,
        "out": out.to_string_lossy(),
        "plan_hash": report.results.plan_hash,
        "program_version": report.results.program_version,
        "axes": report.results.axes,
        "rows": table["points"].take(),
        "fair_ratios": fair.iter().map(fair_to_json).collect::<Vec<_>>(),
        "published": report.results.rows.each().filter_map(|row| published_to_json(&row)).collect::<Vec<_>>(),
    })
}

/// What was published for the launch and ratio of this point.
fn published_to_json(row: &Row) -> Option<Value> {
    let published = row.published.as_ref()?;
    let counts = &published.counts;
    Some(json!({
        "point": row.point,
        "ratio": counts.ratio,
        "source": TABLE1_SOURCE,
        "heads": counts.heads,
        "tails": counts.tails,
        "side": counts.side,
        "unidentified": counts.unidentified,
        "p_side": counts.p_side(),
        "z": counts.z_score(row.tally.side, row.tally.tosses()),
        "differs": published.differs,
    }))
}

fn fair_to_json(fair: &FairRatio) -> Value {
    let at: Map<_, _> = fair
        .at
        .iter()
        .map(|(name, value)| (name.clone(), json!(value)))
        .collect();
    json!({
        "at": at,
        "engine": fair.engine,
        "law": fair.law,
        "target": FAIR,
        "ratio": fair.ratio,
        "lo": fair.lo,
        "hi": fair.hi,
        "confidence": fair.confidence,
        "rising": fair.rising,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_core::Tally;

    #[test]
    fn published_counts_are_told_to_programs() {
        let config = "coin.ratio = [1, 2]\nsurface = { restitution = 0.3, friction = 10 }\n\
                      launch.preset = 'table1'\nengine.volumetric = {}\nstop.tosses = 1103";
        let plan = config::parse("test", config, &[]).unwrap();
        let tally = Tally {
            heads: 608,
            side: 495,
            ..Tally::default()
        };
        let json = |i| published_to_json(&Row::new(&plan, i, tally, StoppedBy::Tosses));
        let at_1 = json(0).unwrap();
        assert_eq!((&at_1["side"], &at_1["z"]), (&json!(495), &json!(0.0)));
        assert_eq!(at_1["p_side"], json!(495.0 / 1103.0));
        assert_eq!(at_1["differs"][0], "radius_m");
        assert_eq!(json(1), None);
    }

    #[test]
    fn no_larger_number_of_tosses_is_asked_for_in_vain() {
        let config = "coin.ratio = [1, 2]\nsurface.landing = 'adhesive'\nlaunch.preset = 'table1'\n\
                      engine.volumetric = {}\nstop = { half_width = 1e-7, max_tosses = 1e15 }";
        let plan = config::parse("test", config, &[]).unwrap();
        let mut rows: OnDemand<Row> = (0..2)
            .map(|i| Row::new(&plan, i, Tally::default(), StoppedBy::MaxTosses))
            .collect();
        let text = short_of_target(&rows);
        assert!(text.contains("2 points reached stop.max_tosses"), "{text}");
        rows[1].stopped_by = StoppedBy::Evaluations;
        let text = short_of_target(&rows);
        assert!(text.contains("1 point reached stop.max_tosses"), "{text}");
        assert!(
            text.contains("\ncoinmc: 1 point reached the limit of an integral"),
            "{text}"
        );
        rows[0].stopped_by = StoppedBy::TotalTosses;
        let text = short_of_target(&rows);
        assert!(
            text.contains("1 point reached the run's stop.total_tosses"),
            "{text}"
        );
        rows[0].stopped_by = StoppedBy::Targets;
        let text = short_of_target(&rows);
        assert!(!text.contains("total_tosses"), "{text}");
    }

    #[test]
    fn only_a_file_that_is_there_is_named() {
        let dir = tempfile::tempdir().unwrap();
        assert_eq!(csv_in(dir.path(), Status::Interrupted), None);
        let csv = dir.path().join("results.partial.csv");
        std::fs::write(&csv, "").unwrap();
        assert_eq!(csv_in(dir.path(), Status::Interrupted), Some(csv));
        assert_eq!(csv_in(dir.path(), Status::Complete), None);
    }
}

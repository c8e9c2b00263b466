//! `coinmc status`: how far runs are.

use super::report::unreadable;
use crate::exit::{Failure, Outcome, several};
use crate::output::{self, Console, FORMAT_VERSION, Format};
use crate::terminal::progress::Progress;
use crate::terminal::{count, grouped};
use clap::Args;
use coinmc::run::{ProgressSink, Report, Status as Finished, is_running, stored_report};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  coinmc status runs/*
  coinmc status runs/first --format json";

/// Show how far runs are
///
/// A line for each run directory: finished, short of its targets, running, stopped or a complete part, with its
/// points and tosses.
/// Nothing in them is changed.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Status {
    /// Run directories
    #[arg(value_name = "RUN_DIR", required = true)]
    runs: Vec<PathBuf>,

    /// How to write the result
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,
}

/// How far a run is.
struct Row {
    run: PathBuf,
    state: &'static str,
    points: usize,
    points_done: usize,
    tosses: u64,
    tosses_planned: u64,
    half_width: f64,
    /// Of the widest interval of the points that are complete; `None` if none is.
    widest: Option<f64>,
}

impl Status {
    pub(crate) fn format(&self) -> Format {
        self.format
    }

    pub(crate) fn execute(&self, console: &Console) -> Result<Outcome, Failure> {
        let progress = Progress::new(*console.stderr(), true);
        let (rows, failures) = self.rows(&progress);
        let printed = match self.format {
            // one document: that of the failures
            Format::Json if !failures.is_empty() => Ok(()),
            Format::Json => output::print_json(&json!({
                "format_version": FORMAT_VERSION,
                "kind": "status",
                "runs": rows.iter().map(Row::to_json).collect::<Vec<_>>(),
            })),
            Format::Table => output::print(&rows.iter().map(Row::line).collect::<String>()),
        };
        printed.map_err(|error| Failure::Runtime(error.into()))?;
        if failures.is_empty() {
            return Ok(Outcome::Done);
        }
        Err(several(failures.into_iter()))
    }

    /// A row for every run directory, and what is wrong with the others.
    fn rows(&self, sink: &dyn ProgressSink) -> (Vec<Row>, Vec<Failure>) {
        let (mut rows, mut failures) = (Vec::new(), Vec::new());
        for run in &self.runs {
            // before the counts are read: a run that ends in the meantime is then called running
            let runs = is_running(run);
            match stored_report(run, sink) {
                Ok((_, report)) => rows.push(Row::new(run, runs, &report)),
                Err(error) => failures.push(unreadable(error)),
            }
        }
        (rows, failures)
    }
}

impl Row {
    fn new(run: &Path, runs: bool, report: &Report) -> Self {
        let rows = &report.results.rows;
        let is_finished = report.status == Finished::Complete;
        let is_over = is_finished || matches!(report.status, Finished::ShortOfTarget { .. });
        let state = match (report.status, runs) {
            (Finished::Complete, _) => "finished",
            (Finished::ShortOfTarget { .. }, _) => "short_of_target",
            (Finished::Part, _) => "part",
            (Finished::Interrupted, true) => "running",
            (Finished::Interrupted, false) => "stopped",
        };
        let told = rows.each();
        let told = told.filter(|row| is_over || row.stopped_by.is_reached());
        let widest = told.map(|row| row.half_width()).reduce(f64::max);
        Self {
            widest,
            run: run.to_owned(),
            state,
            points: rows.len(),
            points_done: if is_finished {
                rows.len()
            } else {
                report.points_reached()
            },
            tosses: report.tosses,
            tosses_planned: report.tosses_planned,
            half_width: rows.each().map(|row| row.half_width()).fold(0.0, f64::max),
        }
    }

    /// `runs/first: stopped, 1 of 3 points, 20 000 of 60 000 tosses (33 %), widest interval ± 0.007`
    fn line(&self) -> String {
        let Self {
            state,
            points_done,
            tosses,
            tosses_planned,
            ..
        } = self;
        let points = count(self.points as u64, "point");
        let state = match *state {
            "part" => "a complete part",
            "short_of_target" => "short of its targets",
            state => state,
        };
        let mut line = format!("{}: {state}, ", self.run.display());
        if *points_done < self.points {
            line += &format!("{} of ", grouped(*points_done as u64));
        }
        line += &format!("{points}, {}", grouped(*tosses));
        if tosses < tosses_planned {
            let share = 100.0 * *tosses as f64 / *tosses_planned as f64;
            line += &format!(" of {} tosses ({share:.0} %)", grouped(*tosses_planned));
        } else {
            line += if *tosses == 1 { " toss" } else { " tosses" };
        }
        if let Some(widest) = self.widest.filter(|_| *tosses > 0) {
            line += &format!(", widest interval ± {widest:.2e}");
        }
        line + "\n"
    }

    fn to_json(&self) -> Value {
        json!({
            "run": self.run.to_string_lossy(),
            "state": self.state,
            "points": self.points,
            "points_done": self.points_done,
            "tosses": self.tosses,
            "tosses_planned": self.tosses_planned,
            "half_width": self.half_width,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc::run::{Options, Part, run};
    use std::sync::atomic::AtomicBool;

    /// A run directory with part 1 of so many.
    fn toss(out: &Path, parts: u32) {
        toss_until(out, parts, "tosses = 20000");
    }

    /// The same until the stop rule says so.
    fn toss_until(out: &Path, parts: u32, stop: &str) {
        let config = format!(
            "coin.ratio = [1, 2]\nsurface = {{ restitution = 0.5, friction = 0 }}\n\
             launch.preset = 'robot'\nengine.flat = {{}}\nstop = {{ {stop} }}"
        );
        let plan = coinmc::config::parse("test", &config, &[]).expect("a config");
        let cancel = AtomicBool::new(false);
        let options = Options {
            out,
            build: "test",
            part: Part::new(1, parts).expect("a part"),
            threads: None,
            cancel: &cancel,
            sink: &(),
        };
        run(&plan, &options).expect("a run");
    }

    fn rows(runs: &[PathBuf]) -> (Vec<Row>, Vec<Failure>) {
        let status = Status {
            runs: runs.to_vec(),
            format: Format::Table,
        };
        status.rows(&())
    }

    #[test]
    fn runs_are_told_beside_all_directories_that_are_none() {
        let dir = tempfile::tempdir().expect("a directory");
        let runs = ["nothing", "first", "neither"].map(|name| dir.path().join(name));
        toss(&runs[1], 1);
        let (rows, failures) = rows(&runs);
        assert_eq!(rows.len(), 1);
        assert!(
            rows[0]
                .line()
                .contains("first: finished, 2 points, 40 000 tosses, widest")
        );
        let told = several(failures.into_iter()).message();
        assert!(told.contains("nothing is not a run directory"), "{told}");
        assert!(told.contains("neither is not a run directory"), "{told}");
    }

    #[test]
    fn a_run_that_missed_its_targets_is_not_finished() {
        let dir = tempfile::tempdir().expect("a directory");
        let run = dir.path().join("short");
        toss_until(&run, 1, "half_width = 0.01, max_tosses = 10");
        let (rows, _) = rows(&[run]);
        let line = rows[0].line();
        assert!(
            line.contains("short: short of its targets, 0 of 2 points, 20 tosses, widest"),
            "{line}"
        );
        assert_eq!(rows[0].to_json()["state"], "short_of_target");
    }

    #[test]
    fn intervals_are_told_of_complete_points_alone() {
        let dir = tempfile::tempdir().expect("a directory");
        // the full chunk of one point and the short one of the other, or all of one
        let runs = [3, 2].map(|parts| dir.path().join(parts.to_string()));
        toss(&runs[0], 3);
        toss(&runs[1], 2);
        let (rows, _) = rows(&runs);
        let line = rows[0].line();
        assert!(line.contains("a complete part, 0 of 2 points"), "{line}");
        assert!(!line.contains("interval"), "{line}");
        assert!(rows[1].line().contains("1 of 2 points"));
        assert!(rows[1].widest.is_some_and(|widest| widest < 0.01));
    }
}

//! `coinmc robot fairness`: is the robot fair?

use super::read;
use crate::exit::{Failure, Outcome};
use crate::output::{self, Console, FORMAT_VERSION, Format};
use crate::terminal::table::{Column, Table};
use crate::terminal::{Style, grouped};
use anyhow::anyhow;
use clap::Args;
use coinmc_robot::fairness::{Check, FairnessReport, SIGNIFICANCE, die_check, fairness};
use serde_json::{Value, json};
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  coinmc robot fairness day
  coinmc robot fairness --counts 170,160,171,158,172,169     a die, counted by hand

`reveals` is the smallest bias that this number of throws detects with \
a probability of 80 % and 95 %: a test that finds nothing rules out \
larger biases.";

/// Check the robot: a fair coin, a fair die, uniform spins and angles; exact tests with their power
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Fairness {
    /// Directory of the experiment
    #[arg(
        value_name = "DIR",
        required_unless_present = "counts",
        conflicts_with = "counts"
    )]
    directory: Option<PathBuf>,

    /// The body is a cube: heads and tails are a face of six each, the side is four
    #[arg(long, requires = "directory")]
    die: bool,

    /// Counts of each face of a die, instead of an experiment
    #[arg(long, value_name = "N,N,…", value_delimiter = ',')]
    counts: Option<Vec<u64>>,

    /// Format of the report
    #[arg(long, value_enum, default_value_t = Format::Table)]
    pub(super) format: Format,
}

impl Fairness {
    pub(super) fn execute(&self, console: &Console) -> Result<Outcome, Failure> {
        let (checks, remarks) = match (&self.counts, &self.directory) {
            (Some(counts), _) => (die(counts)?, Vec::new()),
            (None, Some(directory)) => {
                let (experiment, history) = read(directory)?;
                let report = fairness(&experiment, &history, self.die);
                let remarks = remarks(&report);
                (report.checks, remarks)
            }
            (None, None) => unreachable!("one of the two is required"),
        };
        match console.format() {
            Format::Json => output::print_json(&json!({
                "format_version": FORMAT_VERSION,
                "kind": "robot-fairness",
                "significance": SIGNIFICANCE,
                "checks": checks.iter().map(to_json).collect::<Vec<_>>(),
                "remarks": remarks,
            })),
            Format::Table => output::print(&table(&checks, &remarks, console.stdout())),
        }
        .map_err(|error| Failure::Runtime(error.into()))?;
        Ok(Outcome::Done)
    }
}

/// Checks of counts that were given on the command line.
fn die(counts: &[u64]) -> Result<Vec<Check>, Failure> {
    const MAX: u64 = 1_000_000_000;
    let sum = counts.iter().try_fold(0, |sum: u64, n| sum.checked_add(*n));
    if (2..=100).contains(&counts.len()) && sum.is_some_and(|sum| (1..=MAX).contains(&sum)) {
        Ok(die_check(counts))
    } else {
        Err(Failure::Input(anyhow!(
            "--counts takes one count per face, for 2 to 100 faces and 1 to {MAX} throws in total"
        )))
    }
}

fn remarks(report: &FairnessReport) -> Vec<String> {
    let throws = match &report.void_share {
        Some(share) => format!(
            "{} throws with a result, {} void ({:.2} %, at most {:.2} %): void throws can hide a bias \
             as large as their fraction",
            grouped(report.done),
            grouped(report.voids),
            100.0 * share.value,
            100.0 * share.hi,
        ),
        None => "no throw has ended yet".to_owned(),
    };
    let remarks = report.remarks.iter().cloned();
    std::iter::once(throws).chain(remarks).collect()
}

fn table(checks: &[Check], remarks: &[String], style: &Style) -> String {
    let mut table = Table::new(vec![
        Column::left("check"),
        Column::right("throws"),
        Column::right("fair"),
        Column::right("found"),
        Column::right("95 % interval"),
        Column::right("p-value"),
        Column::right("reveals 80 %"),
        Column::right("95 %"),
        Column::left("test").droppable(1),
    ]);
    for check in checks {
        let found = &check.found;
        let mut p_value = p_value(check.p_value);
        if check.p_value <= SIGNIFICANCE {
            p_value += " *";
        }
        table.push(vec![
            check.name.clone(),
            grouped(check.n),
            format!("{:.4}", check.expected),
            format!("{:.4}", found.value),
            format!("[{:.4}, {:.4}]", found.lo, found.hi),
            p_value,
            bias(check.power.at_80, style),
            bias(check.power.at_95, style),
            check.test.to_owned(),
        ]);
    }
    let mut text = table.render(style).text;
    for remark in remarks {
        text += remark;
        text.push('\n');
    }
    let starred = checks.iter().filter(|c| c.p_value <= SIGNIFICANCE).count();
    text += &match starred {
        0 => format!(
            "No check found a bias at the {:.0} % level; there may be biases smaller than `reveals`.\n",
            100.0 * SIGNIFICANCE
        ),
        _ => format!(
            "* {starred} of {} checks at the {:.0} % level; a fair robot has {:.1} of them on \
             average.\n",
            checks.len(),
            100.0 * SIGNIFICANCE,
            SIGNIFICANCE * checks.len() as f64
        ),
    };
    text
}

/// What is smaller than 1e-20 is not computed exactly.
fn p_value(p: f64) -> String {
    match p {
        p if p < 1e-20 => "< 1e-20".to_owned(),
        p if p < 1e-4 => format!("{p:.1e}"),
        p => format!("{p:.4}"),
    }
}

/// The detectable bias, if there is one.
fn bias(shift: f64, style: &Style) -> String {
    if shift.is_finite() {
        format!("{}{shift:.4}", style.plus_minus())
    } else {
        "none".to_owned()
    }
}

fn to_json(check: &Check) -> Value {
    let finite = |x: f64| x.is_finite().then_some(x);
    json!({
        "name": check.name,
        "test": check.test,
        "throws": check.n,
        "expected": check.expected,
        "found": finite(check.found.value),
        "lo": finite(check.found.lo),
        "hi": finite(check.found.hi),
        "p_value": finite(check.p_value),
        "reveals_at_80": finite(check.power.at_80),
        "reveals_at_95": finite(check.power.at_95),
    })
}

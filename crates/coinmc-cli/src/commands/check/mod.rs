//! `coinmc check`: explains a config before it is run.

mod calibration;
mod jobs;
mod missing;
mod rare;

use crate::exit::{Failure, Outcome};
use crate::interrupt;
use crate::output::{self, Console, FORMAT_VERSION, Format};
use crate::terminal::progress::with_prefix;
use crate::terminal::{Colors, Style, compact, count, duration, grouped, in_ascii, wrapped};
use crate::time_limit;
use anyhow::anyhow;
use calibration::{Cost, PointCost};
use clap::Args;
use coinmc::config::{self, Override, OverrideError};
use coinmc::plan::{Plan, Stop, Targets};
use coinmc_questions::Template;
use jobs::{Jobs, Machines};
use rare::RareFace;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::time::Duration;

const EXAMPLES: &str = "\
Examples:
  coinmc check examples/flat-fair.toml
  coinmc check toss.toml --set 'stop={half_width=1e-4}'      what would that accuracy cost?
  coinmc check toss.toml --format json
  coinmc check toss.toml --nodes 8 --cores 32 --walltime 1h  how to submit it to a cluster
  coinmc check parts/* --missing                             which parts are to be run again";

/// The interval of a closed form.
const EXACT: &str = "exact";
/// Shortest time worth a forecast.
const INSTANT: Duration = Duration::from_millis(1);
/// The interval of an integral.
const STUDENT: &str = "student-t";
/// Columns of the titles.
const INDENT: usize = 10;

/// Validate a config, show what would be computed and estimate the cost
///
/// Every problem of the config is reported at once. The cost comes from tossing some of the points
/// for a moment; nothing is written.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Check {
    /// The config (TOML; `coinmc schema` describes it), or with `--missing` run directories
    #[arg(required = true, value_name = "CONFIG")]
    paths: Vec<PathBuf>,

    /// Replace or add a value of the config, as in `surface.friction=0.2`; repeatable
    #[arg(long = "set", value_name = "KEY=VALUE")]
    overrides: Vec<Set>,

    /// Say which chunks none of these run directories holds, and the parts to run again
    #[arg(long, conflicts_with_all = ["overrides", "nodes", "defaults"])]
    missing: bool,

    /// Plan jobs of at most 30 minutes for a cluster of so many nodes
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    #[arg(conflicts_with = "defaults")]
    nodes: Option<u32>,

    /// Cores of a node
    #[arg(long, value_name = "C", default_value_t = 1, requires = "nodes",
        value_parser = clap::value_parser!(u32).range(1..=1024))]
    cores: u32,

    /// Time limit of a job: 1h, 45min or 01:30:00
    #[arg(long, value_name = "TIME", default_value = "1h", requires = "nodes", value_parser = time_limit::duration)]
    walltime: Duration,

    /// Print the whole config as it is understood, with every default and preset spelled out, as TOML
    #[arg(long, conflicts_with = "format")]
    defaults: bool,

    /// How to write the plan
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,
}

/// A `--set`, and how it was written.
#[derive(Debug, Clone)]
struct Set {
    text: String,
    set: Override,
}

impl FromStr for Set {
    type Err = OverrideError;

    fn from_str(text: &str) -> Result<Self, OverrideError> {
        let (text, set) = (text.to_owned(), text.parse()?);
        Ok(Self { text, set })
    }
}

impl Check {
    pub(crate) fn format(&self) -> Format {
        self.format
    }

    pub(crate) fn execute(&self, console: &Console) -> Result<Outcome, Failure> {
        if self.missing {
            return missing::report(&self.paths, console);
        }
        interrupt::end_at_once(console)?;
        let [config] = &self.paths[..] else {
            return Err(Failure::Input(anyhow!(
                "check takes one config; several run directories need --missing"
            )));
        };
        let overrides: Vec<Override> = self.overrides.iter().map(|set| set.set.clone()).collect();
        let plan = config::load(config, &overrides)?;
        if self.defaults {
            let printed = output::print(&plan.resolved_toml);
            printed.map_err(|error| Failure::Runtime(error.into()))?;
            return Ok(Outcome::Done);
        }
        let cost = calibration::estimate(&plan)?;
        let rare = rare_face(config, &overrides, &plan, &cost)?;
        let machines = self.nodes.map(|nodes| Machines {
            nodes,
            cores: self.cores,
            walltime: self.walltime,
        });
        let jobs = machines.map(|machines| {
            let core_s = cost.time.map_or(0.0, |time| time.as_secs_f64()) * cost.threads as f64;
            let sets = self.overrides.iter().map(|set| set.text.as_str());
            let run = jobs::run(config, sets);
            (machines, Jobs::of(&plan, &run, core_s, &machines))
        });
        match self.format {
            Format::Table => {
                let text = to_text(&plan, &cost, rare.as_ref(), console.stdout());
                output::print(&(text + &about(jobs.as_ref(), console.stdout())))
            }
            Format::Json => {
                let mut document = to_json(&plan, &cost, rare.as_ref());
                document["cluster"] = jobs.map_or(Value::Null, |(_, jobs)| jobs.to_json());
                output::print_json(&document)
            }
        }
        .map_err(|error| Failure::Runtime(error.into()))?;
        Ok(Outcome::Done)
    }
}

/// What another way of tossing would gain for the rarest face.
fn rare_face(
    config: &Path,
    overrides: &[Override],
    plan: &Plan,
    cost: &Cost,
) -> Result<Option<RareFace>, Failure> {
    match (rare::relative_error(plan), cost.rarest) {
        (Some(error), Some(face)) => {
            let text = config::read_text(config)?;
            let name = config.display().to_string();
            let template = Template::new(name, text, overrides);
            RareFace::of(face, error, cost.tosses_per_s, &template).map(Some)
        }
        _ => Ok(None),
    }
}

fn to_text(plan: &Plan, cost: &Cost, rare: Option<&RareFace>, style: &Style) -> String {
    let mut text = String::new();
    let mut item = |title: &str, value: &str| {
        text += &style.paint(Colors::Strong, &format!("{title:<INDENT$}"));
        text += &wrapped(value, style.width - INDENT, INDENT);
    };
    item(
        "plan",
        &format!("{}, seed {}", &plan.hash()[..8], plan.seed),
    );
    item("points", &points(plan));
    item("tosses", &tosses(plan, cost));
    item("intervals", &confidence(plan));
    for group in plan.explain() {
        item(
            "computed",
            &format!(
                "{}: {}",
                count(group.points as u64, "point"),
                group.computed
            ),
        );
        for skipped in &group.skipped {
            item("skipped", skipped);
        }
    }
    for note in &plan.notes {
        item("note", note);
    }
    item("cost", &in_words(cost));
    if let Some(range) = cheapest_and_dearest(plan, cost) {
        item("a point", &range);
    }
    if let Some(rare) = rare {
        item("rare", &rare.in_words());
    }
    if style.unicode { text } else { in_ascii(&text) }
}

/// The jobs of a cluster, if they were asked for. What submits them stays on one line.
fn about(jobs: Option<&(Machines, Jobs)>, style: &Style) -> String {
    let Some((machines, jobs)) = jobs else {
        return String::new();
    };
    let title = |title: &str| style.paint(Colors::Strong, &format!("{title:<INDENT$}"));
    let words = wrapped(&jobs.in_words(machines), style.width - INDENT, INDENT);
    let mut text = title("cluster") + &words;
    if let Some(warning) = jobs.warning {
        text += &(title("note") + &wrapped(warning, style.width - INDENT, INDENT));
    }
    if let Some(submit) = &jobs.submit {
        text += &format!("{}{submit}\n", title("submit"));
    }
    if style.unicode { text } else { in_ascii(&text) }
}

fn points(plan: &Plan) -> String {
    let total = grouped(plan.points.len() as u64);
    if plan.axes.is_empty() {
        return total;
    }
    let axes = plan.axes.iter().map(|axis| {
        let points = plan.points.each();
        let mut values: Vec<f64> = points.filter_map(|point| parameter(&point, axis)).collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        match values[..] {
            [least, .., most] => {
                format!(
                    "{axis} {} to {} ({})",
                    compact(least),
                    compact(most),
                    values.len()
                )
            }
            [only] => format!("{axis} {}", compact(only)),
            [] => axis.clone(),
        }
    });
    format!("{total}: {}", axes.collect::<Vec<_>>().join(", "))
}

fn parameter(point: &coinmc::plan::Point, name: &str) -> Option<f64> {
    point
        .parameters
        .iter()
        .find(|(there, _)| **there == *name)
        .map(|(_, value)| *value)
}

fn tosses(plan: &Plan, cost: &Cost) -> String {
    let total = grouped(plan.tosses_planned());
    match plan.stop {
        _ if plan.tosses_planned() == 0 => "none".to_owned(),
        Stop::Tosses(each) => format!("{} a point, {total} in all", grouped(each)),
        Stop::Targets(targets) => format!(
            "until {}: about {}, {total} at most",
            wanted(&targets),
            grouped(two_digits(cost.tosses))
        ),
    }
}

/// The targets in words.
fn wanted(targets: &Targets) -> String {
    let (interval, face) = match targets.face {
        None => ("every interval".to_owned(), "every face".to_owned()),
        Some(face) => (
            format!("the interval of P({})", face.name()),
            face.name().to_owned(),
        ),
    };
    let half_width = targets
        .half_width
        .map(|arm| format!("{interval} is within ±{}", compact(arm)));
    let relative = targets.relative_error.map(|share| {
        format!(
            "{interval} is within ±{} % of its probability",
            compact(100.0 * share)
        )
    });
    let events = targets
        .events
        .map(|least| format!("{face} was seen {} times", grouped(least)));
    let all: Vec<String> = [half_width, relative, events]
        .into_iter()
        .flatten()
        .collect();
    all.join(" and ")
}

/// The first two digits, then zeros: a forecast has no more.
fn two_digits(n: u64) -> u64 {
    let unit = 10_u64.pow(n.checked_ilog10().unwrap_or(0).saturating_sub(1));
    n / unit * unit
}

fn intervals(plan: &Plan) -> &'static str {
    match plan.stop {
        _ if is_integrated(plan) => STUDENT,
        _ if plan.tosses_planned() == 0 => EXACT,
        Stop::Tosses(_) => plan.interval.name(),
        Stop::Targets(_) => "sequential-clopper-pearson",
    }
}

/// Whether some point is integrated and not exact.
fn is_integrated(plan: &Plan) -> bool {
    (0..plan.points.len()).any(|index| {
        plan.method(index).is_some_and(|method| {
            let left = method.dimensions_left(&plan.points.at(index).launches);
            left > 0
        })
    })
}

fn confidence(plan: &Plan) -> String {
    match intervals(plan) {
        EXACT => "none: closed forms are exact".to_owned(),
        method => format!("{} %, {method}", compact(plan.confidence * 100.0)),
    }
}

fn in_words(cost: &Cost) -> String {
    match cost.time {
        None => "nothing to toss".to_owned(),
        // closed forms
        Some(time) if cost.tosses == 0 && time < INSTANT => "nothing to toss".to_owned(),
        Some(time) if cost.tosses == 0 => format!(
            "nothing to toss; integrals take about {} of one core, {} on {}",
            of_one_core(cost),
            duration(time),
            cost.threads
        ),
        Some(time) => format!(
            "about {} of one core, {} on {} ({} tosses/s on one, as just measured{})",
            of_one_core(cost),
            duration(time),
            cost.threads,
            with_prefix(cost.tosses_per_s),
            if cost.unsure {
                "; unsure, as a few tosses take most of the time"
            } else {
                ""
            }
        ),
    }
}

fn of_one_core(cost: &Cost) -> String {
    duration(Duration::try_from_secs_f64(cost.core_seconds()).unwrap_or(Duration::MAX))
}

/// The range of costs over the points of a sweep, if they differ.
fn cheapest_and_dearest(plan: &Plan, cost: &Cost) -> Option<String> {
    let by_time = |a: &&PointCost, b: &&PointCost| a.seconds.total_cmp(&b.seconds);
    let (least, most) = (
        cost.points.iter().min_by(by_time)?,
        cost.points.iter().max_by(by_time)?,
    );
    let seconds = |point: &PointCost| {
        duration(Duration::try_from_secs_f64(point.seconds).unwrap_or(Duration::MAX))
    };
    let place = |point: &PointCost| {
        let swept = plan.points.at(point.point);
        let axes = plan.axes.iter().filter_map(|axis| {
            let value = parameter(&swept, axis)?;
            Some(format!("{axis} {}", compact(value)))
        });
        axes.collect::<Vec<_>>().join(", ")
    };
    (cost.points.len() > 1).then(|| {
        format!(
            "from {} ({}) to {} ({}) of one core",
            seconds(least),
            place(least),
            seconds(most),
            place(most)
        )
    })
}

/// The document of `--format json`; docs/reference/formats.md describes it.
fn to_json(plan: &Plan, cost: &Cost, rare: Option<&RareFace>) -> Value {
    let groups = plan.explain().into_iter().map(|group| {
        json!({ "points": group.points, "computed": group.computed, "skipped": group.skipped })
    });
    let points_cost = cost.points.iter().map(|point| {
        json!({ "point": point.point, "tosses": point.tosses.round(), "core_s": point.seconds })
    });
    json!({
        "format_version": FORMAT_VERSION,
        "kind": "plan",
        "plan_hash": plan.hash(),
        "seed": plan.seed,
        "axes": plan.axes,
        "points": plan.points.len(),
        "tosses_at_most": plan.tosses_planned(),
        "confidence": plan.confidence,
        "interval": intervals(plan),
        "groups": groups.collect::<Vec<_>>(),
        "notes": plan.notes,
        "cost": {
            "tosses": cost.tosses,
            "threads": cost.threads,
            "tosses_per_s_and_thread": cost.time.map(|_| cost.tosses_per_s),
            "time_s": cost.time.map_or(0.0, |time| time.as_secs_f64()),
            "core_s": cost.core_seconds(),
            "unsure": cost.unsure,
            "points": points_cost.collect::<Vec<_>>(),
        },
        "rare": rare.map(|rare| json!({ "face": rare.face.name(), "gain": rare.gain.map(|gain| gain.tosses), "gain_of_work": rare.gain.map(|gain| gain.work) })),
        "resolved_config": plan.resolved_toml,
    })
}

#[cfg(test)]
mod tests {
    use super::two_digits;

    #[test]
    fn forecasts_have_two_digits() {
        let rounded = [0, 7, 99, 14_680_064, u64::MAX].map(two_digits);
        assert_eq!(rounded, [0, 7, 99, 14_000_000, 18_000_000_000_000_000_000]);
    }
}

//! What the pages say: the data of runs, of tosses, of maps.

use crate::html::{Program, document};
use crate::map::Map;
use crate::run::{MAX_POINTS, Run};
use crate::samples::Samples;
use crate::{fair, history, published, replay, rules, sweep, table};
use coinmc::plan::Plan;
use coinmc::results::Results;
use coinmc::run::Status;
use coinmc_trace::{Trace, TraceError};
use serde_json::{Value, json};

/// Most tosses of a page.
pub const MAX_TOSSES: usize = 24;

/// The page of one or several runs, side by side.
///
/// # Errors
/// [`TraceError`] if a point or toss that `samples` names does not exist.
///
/// # Example
/// ```
/// use coinmc::run::count;
/// use coinmc_report::{Run, Samples, report};
/// let plan = coinmc::config::parse("inline", "
///     coin.ratio = [1, 2]
///     surface = { restitution = 0.5, friction = 0.3 }
///     launch.preset = 'robot'
///     engine.flat = {}
///     stop.tosses = 100
/// ", &[]).unwrap();
/// let cancel = std::sync::atomic::AtomicBool::new(false);
/// let counted = count(&plan, &coinmc::run::Count { threads: None, cancel: &cancel, sink: &() })?;
/// let run = Run::in_memory("an example", plan, counted);
/// let page = report(&[run], None, &Samples::default())?;
/// assert!(page.starts_with("<!doctype html>"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn report(runs: &[Run], title: Option<&str>, samples: &Samples) -> Result<String, TraceError> {
    let names: Vec<&str> = runs.iter().map(|run| run.name.as_str()).collect();
    let title = title.map_or_else(|| names.join(", "), str::to_owned);
    let told: Result<Vec<Value>, TraceError> =
        runs.iter().map(|run| run_to_json(run, samples)).collect();
    let data = json!({
        "page": "report",
        "title": title,
        "program": env!("CARGO_PKG_VERSION"),
        "kinds": replay::KINDS,
        "runs": told?,
    });
    Ok(document(&title, &data, Program::Report))
}

/// The page of tosses in three dimensions, one scene for all of them; each with the plan it was recorded of.
///
/// # Panics
/// If a trace is not of its plan.
pub fn tosses(traces: &[(&Plan, &Trace)]) -> String {
    let title = match traces {
        [(_, one)] => format!("Toss {} of point {}", one.toss, one.point),
        _ => format!("{} tosses", traces.len()),
    };
    let names = telling(traces);
    let mut configs: Vec<&str> = Vec::new();
    for (plan, _) in traces {
        if !configs.contains(&plan.resolved_toml.as_str()) {
            configs.push(&plan.resolved_toml);
        }
    }
    let tosses = traces
        .iter()
        .map(|(plan, trace)| replay::toss(plan, trace, &names));
    let data = json!({
        "page": "tosses",
        "title": title,
        "program": env!("CARGO_PKG_VERSION"),
        "kinds": replay::KINDS,
        "configs": configs,
        "tosses": tosses.collect::<Vec<_>>(),
    });
    document(&title, &data, Program::Toss)
}

/// The parameters that tell tosses apart: swept ones, and those in which their points differ.
fn telling(traces: &[(&Plan, &Trace)]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    if let Some((first, _)) = traces.first()
        && traces
            .iter()
            .all(|(plan, _)| plan.resolved_toml == first.resolved_toml)
    {
        // what follows from swept parameters tells nothing new
        return first.axes.clone();
    }
    for (plan, trace) in traces {
        for (name, value) in &plan.points[trace.point].parameters {
            let differs = |(plan, trace): &(&Plan, &Trace)| {
                let there = &plan.points[trace.point].parameters;
                there
                    .iter()
                    .any(|(other, found)| other == name && found != value)
            };
            let tells = plan.axes.iter().any(|axis| **axis == **name) || traces.iter().any(differs);
            if tells && !names.iter().any(|known| **known == **name) {
                names.push(name.to_string());
            }
        }
    }
    names
}

/// The page of a map of basins, each pixel of which can be watched.
pub fn map(plan: &Plan, map: &Map) -> String {
    let title = "Basins of heads, tails and side";
    let data = json!({
        "page": "map",
        "title": title,
        "program": env!("CARGO_PKG_VERSION"),
        "kinds": replay::KINDS,
        "configs": [plan.resolved_toml],
        "map": map.to_json(plan),
    });
    document(title, &data, Program::Toss)
}

fn run_to_json(run: &Run, samples: &Samples) -> Result<Value, TraceError> {
    let (plan, results) = (&run.plan, &run.report.results);
    let (rows, word) = sweep::thinned(results, MAX_POINTS);
    let shown = Results {
        rows: rows
            .iter()
            .map(|&i| results.rows.at(i).into_owned())
            .collect(),
        ..results.clone()
    };
    Ok(json!({
        "name": run.name,
        "status": status(run.report.status),
        "points_done": run.report.points_reached(),
        "points": results.rows.len(),
        "thinned": word,
        "tosses": run.report.tosses,
        "seed": plan.seed,
        "paired": plan.paired,
        "confidence": plan.confidence,
        "plan_hash": results.plan_hash,
        "program_version": results.program_version,
        "manifest": run.manifest,
        "made_by": run.provenance.to_json(),
        "config": results.config,
        "axes": results.axes,
        "columns": table::to_json(&shown),
        "rule": rules::to_json(&shown),
        "fair": fair::to_json(results),
        "published": published::to_json(results),
        "history": history::to_json(plan, &run.history),
        "samples": samples.of(plan, &shown.rows)?,
    }))
}

fn status(status: Status) -> &'static str {
    match status {
        Status::Complete => "complete",
        Status::Interrupted => "interrupted",
        Status::Part => "part",
        Status::ShortOfTarget { .. } => "short_of_target",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc::plan::StoppedBy;
    use coinmc::results::Row;
    use coinmc::run::Report;
    use coinmc_core::Tally;
    use coinmc_trace::replay;

    fn run(config: &str, tally: Tally, status: Status) -> Run {
        let plan = coinmc::config::parse("test", config, &[]).unwrap_or_else(|e| panic!("{e}"));
        let row = |i| Row::new(&plan, i, tally, StoppedBy::Tosses);
        let report = Report {
            results: Results::new(&plan, (0..plan.points.len()).map(row).collect()),
            status,
            reused_chunks: 0,
            tosses: 0,
            tosses_planned: 0,
        };
        Run::in_memory("a", plan, report)
    }

    fn counted() -> Tally {
        Tally {
            heads: 300,
            tails: 308,
            side: 495,
            ..Tally::default()
        }
    }

    #[test]
    fn published_counts_stand_beside_those_of_the_same_launch() {
        let config = "coin.ratio = [1, 2]\nsurface = { restitution = 0.3, friction = 10 }\n\
            launch.preset = 'table1'\nengine.volumetric = {}\nstop.tosses = 1103";
        let run = run(config, counted(), Status::Complete);
        let told = run_to_json(&run, &Samples::default()).unwrap();
        let [one] = &told["published"]["counts"].as_array().unwrap()[..] else {
            panic!("{}", told["published"])
        };
        assert_eq!(
            (&one["ratio"], &one["side"], &one["z"]),
            (&json!(1.0), &json!(495), &json!(0.0))
        );
        assert_eq!(told["published"]["fair_ratios"][0]["ratio"], 0.8);
        // an example of each face, where one is found soon
        assert!(!told["samples"].as_array().unwrap().is_empty());
        assert_eq!(
            told["rule"]["rows"],
            json!([0.447_213_595_499_957_9, 0.707_106_781_186_547_5])
        );
    }

    #[test]
    fn closed_forms_have_no_tosses_to_show() {
        let config = "coin.ratio = [1.0, 2.0]\nengine.analytic.rule = 'arc'";
        let run = run(config, Tally::default(), Status::Complete);
        let told = run_to_json(&run, &Samples::default()).unwrap();
        assert_eq!(
            (&told["samples"], &told["rule"]),
            (&json!([]), &Value::Null)
        );
        // P(side) = 1/2 and about 0.295 lie on both sides of 1/3
        assert_eq!(told["fair"][0]["found"], 1);
        let asked = Samples {
            point: Some(0),
            tosses: vec![1],
        };
        assert!(run_to_json(&run, &asked).is_err());
    }

    /// Of a config swept, by its axes; of two configs, by what differs.
    #[test]
    fn tosses_are_told_apart_by_what_differs() {
        let config = |e: &str| {
            let text = format!(
                "coin.ratio = 1\nsurface = {{ restitution = {e}, friction = 0.3 }}\n\
                 launch.preset = 'robot'\nengine.flat = {{}}\nstop.tosses = 10"
            );
            coinmc::config::parse("test", &text, &[]).unwrap_or_else(|e| panic!("{e}"))
        };
        let (a, b, swept) = (config("0.3"), config("0.7"), config("[0.3, 0.7]"));
        let trace = |plan, point| replay(plan, point, 3, 100.0).unwrap();
        let (x, y) = (trace(&a, 0), trace(&b, 0));
        assert_eq!(telling(&[(&a, &x), (&b, &y)]), ["restitution"]);
        assert_eq!(telling(&[(&a, &x)]), [""; 0]);
        let z = trace(&swept, 1);
        assert_eq!(telling(&[(&swept, &z)]), ["restitution"]);
        let page = tosses(&[(&a, &x), (&b, &y)]);
        assert!(page.contains("\"at\":[[\"restitution\",0.7]]"));
    }
}

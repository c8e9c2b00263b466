//! The report of traces, as text and as JSON.

use super::Trace;
use super::select::{Selected, Status};
use crate::exit::{Failure, Outcome};
use crate::output::{self, Console, FORMAT_VERSION, Format};
use crate::terminal::events::events;
use crate::terminal::table::{Column, Table};
use crate::terminal::{Style, compact, grouped, tosses};
use coinmc::plan::Plan;
use coinmc_trace::{Trace as Recorded, outcome_name};
use serde_json::{Value, json};
use std::path::PathBuf;

/// Prints the result to standard output, and notes to standard error unless quiet.
pub(super) fn present(
    trace: &Trace,
    plan: &Plan,
    selected: &Selected,
    traces: &[Recorded],
    files: &[PathBuf],
    console: &Console,
) -> Result<Outcome, Failure> {
    match console.format() {
        Format::Json => output::print_json(&to_json(plan, selected, traces, files)),
        Format::Table => output::print(&to_text(trace, traces, files, console.stdout())),
    }
    .map_err(|error| Failure::Runtime(error.into()))?;
    if !trace.quiet {
        for remark in remarks(trace, selected, traces) {
            output::note(&remark);
        }
    }
    Ok(match selected.status {
        Status::Complete => Outcome::Done,
        Status::Short { .. } => Outcome::ShortOfTarget,
        Status::Interrupted => Outcome::Interrupted,
    })
}

fn to_text(trace: &Trace, traces: &[Recorded], files: &[PathBuf], style: &Style) -> String {
    let mut text = String::new();
    if trace.show {
        for recorded in traces {
            text += &events(recorded, trace.all, style);
            text.push('\n');
        }
    } else if !traces.is_empty() {
        text += &overview(traces, style);
        text.push('\n');
    }
    for file in files {
        text += &format!("Written: {}\n", file.display());
    }
    text.truncate(text.trim_end().len());
    if !text.is_empty() {
        text.push('\n');
    }
    text
}

/// One line per toss.
fn overview(traces: &[Recorded], style: &Style) -> String {
    let mut table = Table::new(vec![
        Column::right("point"),
        Column::right("toss"),
        Column::left("outcome"),
        Column::right("impacts"),
        Column::right("time/s"),
        Column::right("records"),
        Column::right("samples/s").droppable(1),
    ]);
    for trace in traces {
        table.push(vec![
            trace.point.to_string(),
            trace.toss.to_string(),
            outcome_name(&trace.outcome).to_owned(),
            trace.outcome.impacts.to_string(),
            compact(trace.duration_s()),
            grouped(trace.records.len() as u64),
            compact(trace.rate_hz),
        ]);
    }
    table.render(style).text
}

/// Notes beside the result.
fn remarks(trace: &Trace, selected: &Selected, traces: &[Recorded]) -> Vec<String> {
    let mut remarks = Vec::new();
    if let Some(searched) = selected.searched {
        let found = selected.tosses.len() as u64;
        let searched = tosses(searched);
        remarks.push(match selected.status {
            Status::Interrupted => format!("coinmc: stopped after {searched}; no file was written"),
            Status::Short { limit: true } => format!(
                "coinmc: found {found} of {} in {searched}; search further with --limit",
                trace.count
            ),
            Status::Short { limit: false } => format!(
                "coinmc: found {found} of {}; all {searched} were searched",
                trace.count
            ),
            Status::Complete => format!("coinmc: searched {searched}"),
        });
    }
    for cut in traces.iter().filter(|t| t.samples_until_s.is_some()) {
        remarks.push(format!(
            "coinmc: point {}, toss {}: no samples after {} s because there are too many; lower --rate",
            cut.point,
            cut.toss,
            compact(cut.samples_until_s.unwrap_or_default()),
        ));
    }
    remarks
}

/// The document of `--format json`; docs/reference/formats.md describes it.
fn to_json(plan: &Plan, selected: &Selected, traces: &[Recorded], files: &[PathBuf]) -> Value {
    let status = match selected.status {
        Status::Complete => "complete",
        Status::Short { .. } => "short_of_target",
        Status::Interrupted => "interrupted",
    };
    json!({
        "format_version": FORMAT_VERSION,
        "kind": "trace",
        "status": status,
        "plan_hash": plan.hash(),
        "program_version": env!("CARGO_PKG_VERSION"),
        "searched": selected.searched,
        "tosses": traces.iter().map(|trace| trace.to_json(plan)).collect::<Vec<_>>(),
        "files": files.iter().map(|file| file.to_string_lossy()).collect::<Vec<_>>(),
    })
}

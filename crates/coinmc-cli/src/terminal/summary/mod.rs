//! The summary of a run as text: table, plot, fair ratios, published counts, undecided tosses,
//! files.

mod curves;
mod fair;
mod published;
mod side_endings;
mod totals;

use super::plot::{Level, Plot, Plotted, Reference};
use super::table::{Column, Table};
use super::{Style, compact, count, grouped, with_interval, wrapped};
use coinmc::engines::no_bounce_rule;
use coinmc::results::{FairRatio, Results, Row};
use coinmc_core::{Estimate, Face};
use curves::curves;
use std::path::Path;
use totals::Totals;

/// P(side) of a fair coin.
pub(crate) const FAIR: f64 = 1.0 / 3.0;

/// The parameter that plots are drawn over unless another is asked for.
const RATIO: &str = "ratio";
/// Longer tables show only the first and last `END` points.
const LONG: usize = 60;
const END: usize = 20;

/// A piped table is whole, unless it is so long that nobody reads it and it would take more memory than the run.
const TOO_LONG: usize = 10_000;

/// Whether a table of so many rows is shown whole.
fn is_whole(rows: usize, style: &Style) -> bool {
    style.whole && rows <= TOO_LONG
}

/// The whole summary of the results, which are in the file `csv` if there is one.
pub(crate) fn summary(
    results: &Results,
    fair: &[FairRatio],
    csv: Option<&Path>,
    plotted: &Plotted,
    style: &Style,
) -> String {
    let totals = Totals::of(results);
    let mut parts = vec![table(results, &totals, csv, style)];
    if let Plotted::Face { face, along } = plotted {
        parts.extend(plot(
            results,
            *face,
            along.as_deref().unwrap_or(RATIO),
            style,
        ));
    }
    if results.axes.iter().any(|axis| axis == RATIO) {
        let curves = curves(results, RATIO, Face::Side);
        parts.extend(fair::table(results, &totals, fair, &curves, style));
    }
    parts.extend(published::table(results, &totals, style));
    parts.push(closing(&totals, csv, style));
    parts.join("\n")
}

/// The table of the points as Markdown, whole.
pub(crate) fn markdown(results: &Results, style: &Style) -> String {
    points(results, &Totals::of(results), style, 0).markdown()
}

/// One row per point.
fn table(results: &Results, totals: &Totals, csv: Option<&Path>, style: &Style) -> String {
    let rows = &results.rows;
    let hidden = if rows.len() > LONG && !is_whole(rows.len(), style) {
        rows.len() - 2 * END
    } else {
        0
    };
    let mut text = points(results, totals, style, hidden).render(style).text;
    if hidden > 0 {
        let place = csv.map_or("--format csv".to_owned(), |csv| csv.display().to_string());
        text += &format!("All {} points: {place}\n", grouped(rows.len() as u64));
    }
    text
}

/// A row for each point, but for so many in the middle.
fn points(results: &Results, totals: &Totals, style: &Style, hidden: usize) -> Table {
    let shown = shown_parameters(results);
    let mut columns: Vec<Column> = shown.iter().map(|name| Column::right(*name)).collect();
    columns.extend([
        Column::right("P(heads)").droppable(2),
        Column::right("P(tails)").droppable(3),
        Column::right("P(side)"),
    ]);
    let (has_edge, decimals) = (totals.has_edge, totals.decimals);
    columns.extend(has_edge.then(|| Column::right("P(left)")));
    columns.extend([
        Column::right("tosses").droppable(4),
        Column::right("undecided").droppable(1),
    ]);
    let mut table = Table::new(columns);
    let rows = &results.rows;
    for i in 0..rows.len() {
        if hidden > 0 && i == END {
            table.push_gap(hidden as u64);
        }
        if hidden == 0 || i < END || i >= END + hidden {
            table.push(cells(&rows.at(i), &shown, has_edge, decimals, style));
        }
    }
    table
}

/// Swept parameters, or the ratio where nothing is swept.
fn shown_parameters(results: &Results) -> Vec<&str> {
    if results.axes.is_empty() {
        vec![RATIO]
    } else {
        results.axes.iter().map(String::as_str).collect()
    }
}

fn cells(row: &Row, shown: &[&str], has_edge: bool, decimals: usize, style: &Style) -> Vec<String> {
    let parameter = |name: &&str| row.parameter(name).map_or("-".to_owned(), compact);
    let mut cells: Vec<String> = shown.iter().map(parameter).collect();
    let show = |p| probability(p, row, decimals, style);
    cells.extend([&row.heads, &row.tails, &row.side].map(show));
    if has_edge {
        cells.push(row.left.as_ref().map_or("-".to_owned(), show));
    }
    cells.extend([tosses(row), grouped(row.tally.undecided())]);
    cells
}

/// Tosses, or the evaluations of an integral.
fn tosses(row: &Row) -> String {
    if row.evaluations > 0 {
        count(row.evaluations, "evaluation")
    } else {
        grouped(row.tally.tosses())
    }
}

fn probability(p: &Estimate, row: &Row, decimals: usize, style: &Style) -> String {
    if row.interval == "exact" {
        format!("{:.decimals$} exact", p.p)
    } else if p.n == 0 {
        "-".to_owned()
    } else {
        with_interval(p, decimals, style.plus_minus())
    }
}

/// P(face) along an axis, a curve for each combination of the other axes; `None` if it is not swept.
fn plot(results: &Results, face: Face, along: &str, style: &Style) -> Option<String> {
    if !results.axes.iter().any(|axis| axis == along) {
        return None;
    }
    // a config names one engine, and the closed forms depend on the ratio alone
    let first = results.rows.each().next().filter(|_| along == RATIO);
    let rule = first.and_then(|row| no_bounce_rule(row.engine));
    let label = rule.map_or(String::new(), |rule| format!("{rule} rule (no bounce)"));
    let p_face = |ratio| {
        let p_side = rule.map_or(f64::NAN, |rule| rule.p_side(ratio));
        if face == Face::Side {
            p_side
        } else {
            0.5 * (1.0 - p_side)
        }
    };
    let reference = Reference {
        label: &label,
        y: &p_face,
    };
    Plot {
        x_label: if along == RATIO { "ratio H/R" } else { along },
        y_label: &format!("P({})", face.name()),
        curves: &curves(results, along, face),
        reference: rule.is_some().then_some(reference),
        level: (face == Face::Side).then_some(Level {
            label: "1/3",
            y: FAIR,
        }),
    }
    .render(style)
}

/// Undecided tosses, how tosses on the side came there, and the path of the results, if they have one.
fn closing(totals: &Totals, csv: Option<&Path>, style: &Style) -> String {
    let tally = &totals.tally;
    let (made, undecided) = (tally.tosses(), tally.undecided());
    let mut text = String::new();
    if undecided > 0 {
        let reasons = [
            (tally.time_limit, "at the limit of time"),
            (tally.never_settles, "forever"),
            (tally.impact_limit, "at the limit of impacts or of steps"),
            (tally.failed, "failed"),
        ];
        let reasons = reasons.iter().filter(|(count, _)| *count > 0);
        let reasons = reasons.map(|(count, reason)| format!("{} {reason}", grouped(*count)));
        let sentence = format!(
            "Undecided: {} of {} ({}): {}",
            grouped(undecided),
            super::tosses(made),
            share(undecided, made),
            reasons.collect::<Vec<_>>().join(", ")
        );
        text += &wrapped(&sentence, style.width, 4);
    }
    let sentence = side_endings::sentence(tally);
    text += &sentence.map_or(String::new(), |text| wrapped(&text, style.width, 4));
    text + &csv.map_or(String::new(), |csv| format!("Results: {}\n", csv.display()))
}

/// `100 %`, `12.3 %` or, of less than a hundredth, `2.5e-4`.
fn share(some: u64, all: u64) -> String {
    let share = some as f64 / all as f64;
    if share < 0.01 {
        return format!("{share:.1e}");
    }
    let percent = libm::round(1e4 * share) / 100.0;
    // all are said of all only
    let most = if some == all { 100.0 } else { 99.99 };
    format!("{} %", compact(percent.min(most)))
}

#[cfg(test)]
mod tests;

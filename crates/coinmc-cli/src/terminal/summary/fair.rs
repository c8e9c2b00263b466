//! Where the curves cross 1/3.

use super::curves::{label, others};
use super::totals::Totals;
use super::{Curve, FAIR};
use crate::terminal::plot::Mark;
use crate::terminal::table::{Column, Table};
use crate::terminal::{Colors, Style, compact, decimals_for, in_ascii};
use coinmc::engines::no_bounce_rule;
use coinmc::published;
use coinmc::results::{FairRatio, Results};
use std::collections::HashSet;

/// More crossings than this are not listed; JSON has them all.
const MOST: usize = 20;

/// One row per crossing, and a line about curves that never cross. `None` if the sweep does not have
/// two ratios to interpolate between.
pub(super) fn table(
    results: &Results,
    totals: &Totals,
    fair: &[FairRatio],
    curves: &[Curve],
    style: &Style,
) -> Option<String> {
    if curves.iter().all(|curve| curve.marks.len() < 2) {
        return None;
    }
    let tossed = totals.is_tossed;
    let never = if tossed {
        never(fair, curves)
    } else {
        String::new()
    };
    if fair.is_empty() {
        // points without a toss say nothing
        return tossed.then(|| format!("Fair ratio: none in this sweep, {never}\n"));
    }
    let mut columns: Vec<Column> = others(results).into_iter().map(Column::right).collect();
    let percent = compact(fair[0].confidence * 100.0);
    columns.push(Column::right("fair H/R"));
    // Closed forms have no error but that of the interpolation.
    columns.push(Column::left(if no_bounce_rule(fair[0].engine).is_none() {
        "interpolated within".to_owned()
    } else {
        format!("{percent} % interval")
    }));
    let mut table = Table::new(columns);
    // Two digits of the shortest interval's arm, four decimals where all are open.
    let arms = fair
        .iter()
        .filter_map(|c| Some((c.hi? - c.lo?) / 2.0))
        .filter(|arm| *arm > 0.0);
    let least = arms.fold(f64::INFINITY, f64::min);
    let decimals = if least.is_finite() {
        decimals_for(least)
    } else {
        4
    };
    for crossing in fair.iter().take(MOST) {
        let mut cells: Vec<String> = crossing
            .at
            .iter()
            .map(|(_, value)| compact(*value))
            .collect();
        cells.extend([
            ratio(crossing.ratio, decimals),
            interval(crossing, decimals),
        ]);
        table.push(cells);
    }
    if fair.len() > MOST {
        table.push_gap((fair.len() - MOST) as u64);
    }
    let title = style.paint(Colors::Strong, "Fair coin, P(side) = 1/3:");
    let mut text = format!("{title}\n{}", table.render(style).text);
    if !never.is_empty() {
        text += &format!("No crossing elsewhere: {never}\n");
    }
    text += &references(fair[0].engine, style);
    Some(text)
}

/// Published fair ratios of the kind of toss that this engine computes; none for a closed form.
fn references(engine: &str, style: &Style) -> String {
    let Some(rule) = no_bounce_rule(engine) else {
        return String::new();
    };
    let mut text = format!(
        "For comparison:\n    {:<10}  {} rule, no bounce\n",
        format!("{:.4}", rule.fair_ratio(FAIR)),
        rule.name()
    );
    for published in published::fair_ratios(engine) {
        let ratio = format!("{} ± {}", published.ratio, published.half_width);
        text += &format!("    {ratio:<10}  {}\n", published.source);
    }
    if style.unicode { text } else { in_ascii(&text) }
}

/// `[1.4981, 1.5080]`; an end that lies outside the sweep is open.
fn interval(crossing: &FairRatio, decimals: usize) -> String {
    let end = |end: Option<f64>| end.map(|x| ratio(x, decimals));
    let lo = end(crossing.lo).unwrap_or_else(|| "below the sweep".to_owned());
    let hi = end(crossing.hi).unwrap_or_else(|| "above the sweep".to_owned());
    format!("[{lo}, {hi}]")
}

fn ratio(x: f64, decimals: usize) -> String {
    if (1e-4..1e6).contains(&x) {
        format!("{x:.decimals$}")
    } else {
        compact(x)
    }
}

/// How many curves stay on one side of 1/3: `2 curves stay below 1/3, 1 curve stays above 1/3`.
fn never(fair: &[FairRatio], curves: &[Curve]) -> String {
    let crossed: HashSet<String> = fair.iter().map(|crossing| label(&crossing.at)).collect();
    let (below, above): (Vec<&Mark>, Vec<&Mark>) = curves
        .iter()
        .filter(|curve| !crossed.contains(&curve.label))
        .filter_map(|curve| curve.marks.iter().find(|mark| mark.y.is_finite()))
        .partition(|mark| mark.y < FAIR);
    let phrase = |n: usize, place: &str| match n {
        0 => None,
        1 => Some(format!("1 curve stays {place} 1/3")),
        _ => Some(format!("{n} curves stay {place} 1/3")),
    };
    let phrases = [phrase(below.len(), "below"), phrase(above.len(), "above")];
    phrases.into_iter().flatten().collect::<Vec<_>>().join(", ")
}

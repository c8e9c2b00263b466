//! Where the curves cross 1/3.

use super::curves::{label, others};
use super::totals::Totals;
use super::{FAIR, RATIO, is_whole};
use crate::terminal::plot::Curve;
use crate::terminal::table::{Column, Table};
use crate::terminal::{Colors, Style, compact, decimals_for, in_ascii, wrapped};
use coinmc::engines::no_bounce_rule;
use coinmc::published;
use coinmc::results::{FairRatio, Results};
use coinmc_core::Coin;
use std::collections::{HashMap, HashSet};

/// More crossings than this are not listed; JSON has them all.
const MOST: usize = 20;
/// So many curves without a crossing are named.
const NAMED: usize = 3;
/// An interval of this share of a step of the sweep is as wide as it.
const WIDE: f64 = 0.9;

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
        let text = format!("Fair ratio: none found in this sweep: {never}");
        return tossed.then(|| wrapped(&text, style.width, 4));
    }
    let mut columns: Vec<Column> = others(results, RATIO)
        .into_iter()
        .map(Column::right)
        .collect();
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
    let most = if is_whole(fair.len(), style) {
        fair.len()
    } else {
        MOST
    };
    for crossing in fair.iter().take(most) {
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
    if fair.len() > most {
        table.push_gap((fair.len() - most) as u64);
    }
    let title = style.paint(Colors::Strong, "Fair coin, P(side) = 1/3:");
    let mut text = format!("{title}\n{}", table.render(style).text);
    text += &heights(results, fair, style);
    if !never.is_empty() {
        text += &wrapped(&format!("No crossing elsewhere: {never}"), style.width, 4);
    }
    text += &coarse(fair, curves, style);
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

/// The fair heights in mm, if there is one radius and it is not the one that is taken where none is
/// given.
fn heights(results: &Results, fair: &[FairRatio], style: &Style) -> String {
    let mut radii = results.rows.each().map(|row| row.parameter("radius_m"));
    let (Some(Some(radius_m)), [crossing]) = (radii.next(), fair) else {
        return String::new();
    };
    if radius_m == Coin::DEFAULT_RADIUS_M || radii.any(|other| other != Some(radius_m)) {
        return String::new();
    }
    let mm = |ratio: f64| compact(libm::round(ratio * radius_m * 1e6) / 1e3);
    let end = |end: Option<f64>| end.map_or(style.ellipsis().to_owned(), mm);
    format!(
        "With R = {} mm: H = {} mm [{}, {}]\n",
        compact(radius_m * 1e3),
        mm(crossing.ratio),
        end(crossing.lo),
        end(crossing.hi),
    )
}

/// Where intervals are as wide as the steps of the sweep, what would narrow them.
fn coarse(fair: &[FairRatio], curves: &[Curve], style: &Style) -> String {
    let sorted = |curve: &Curve| {
        let mut xs: Vec<f64> = curve.marks.iter().map(|mark| mark.x).collect();
        xs.sort_by(f64::total_cmp);
        xs
    };
    // once for each curve: both may be many
    let all = curves
        .iter()
        .map(|curve| (curve.label.as_str(), sorted(curve)));
    let all: HashMap<&str, Vec<f64>> = all.collect();
    let around = |crossing: &FairRatio| {
        let xs = all.get(label(&crossing.at).as_str())?;
        let after = xs
            .partition_point(|x| *x <= crossing.ratio)
            .clamp(1, xs.len() - 1);
        let (left, right) = (xs[after - 1], xs[after]);
        let lo = crossing.lo.unwrap_or(f64::NEG_INFINITY);
        let hi = crossing.hi.unwrap_or(f64::INFINITY);
        (hi - lo >= WIDE * (right - left)).then_some((left, right))
    };
    let mut places: Vec<(f64, f64)> = fair.iter().filter_map(around).collect();
    places.sort_by(|a, b| a.0.total_cmp(&b.0));
    places.dedup();
    let (Some((from, _)), Some((_, to))) = (places.first(), places.last()) else {
        return String::new();
    };
    let text = format!(
        "An interval as wide as a step of the sweep: add points between {} and {}, or toss more",
        compact(*from),
        compact(*to)
    );
    wrapped(&text, style.width, 4)
}

/// What is said of a curve without a crossing, and of several.
const SAID: [[&str; 2]; 4] = [
    ["stays below 1/3", "stay below 1/3"],
    ["stays above 1/3", "stay above 1/3"],
    [
        "is somewhere too near 1/3 to tell",
        "are somewhere too near 1/3 to tell",
    ],
    [
        "has no toss that showed a face",
        "have no toss that showed a face",
    ],
];

/// What is known of the curves without a crossing: `restitution 0.3 stays below 1/3`, or, of more than a
/// few, how many.
fn never(fair: &[FairRatio], curves: &[Curve]) -> String {
    let crossed: HashSet<String> = fair.iter().map(|crossing| label(&crossing.at)).collect();
    let others = curves
        .iter()
        .filter(|curve| !crossed.contains(&curve.label));
    let mut known: [Vec<&str>; SAID.len()] = Default::default();
    for curve in others {
        if let Some(kind) = kind(curve) {
            known[kind].push(&curve.label);
        }
    }
    let phrases = known.iter().zip(SAID);
    let phrases = phrases.filter(|(labels, _)| !labels.is_empty());
    let phrases: Vec<String> = phrases.map(|(labels, said)| phrase(labels, said)).collect();
    phrases.join(", ")
}

/// Which of [`SAID`] is true of a curve; `None` without points.
fn kind(curve: &Curve) -> Option<usize> {
    let marks: Vec<_> = curve.marks.iter().filter(|m| m.y.is_finite()).collect();
    // without a face a toss may be of either kind: nothing is known of the probability
    let kinds = [
        marks.iter().all(|mark| mark.hi < FAIR),
        marks.iter().all(|mark| mark.lo > FAIR),
        marks.iter().any(|mark| mark.lo > 0.0 || mark.hi < 1.0),
        true,
    ];
    let kind = kinds.into_iter().position(|is| is);
    kind.filter(|_| !marks.is_empty())
}

fn phrase(labels: &[&str], [of_one, of_many]: [&str; 2]) -> String {
    match labels {
        [""] => format!("the curve {of_one}"),
        [one] => format!("{one} {of_one}"),
        few if few.len() <= NAMED => format!("{} {of_many}", few.join("; ")),
        many => format!("{} curves {of_many}", many.len()),
    }
}

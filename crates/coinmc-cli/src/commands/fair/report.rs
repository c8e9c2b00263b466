//! The answer as text.

use super::super::other_size::OtherSize;
use super::Answered;
use crate::terminal::table::{Column, Table};
use crate::terminal::{
    Colors, Style, compact, decimals_for, decimals_that_show, grouped, in_ascii, signed, tosses,
    wrapped,
};
use coinmc::config::Override;
use coinmc_core::Coin;
use coinmc_questions::assumptions::Effect;
use coinmc_questions::{Curve, Fair, Finding, Root, Scanned};

/// What the command line has to do with the text of an answer.
pub(super) struct Shown<'a> {
    /// What it changes of the scene.
    pub(super) overrides: &'a [Override],
    /// What it gives in place of the config's diameter.
    pub(super) other_size: Option<OtherSize>,
    /// Whether it asks how the search went.
    pub(super) search: bool,
}

/// The whole answer.
pub(super) fn text(answered: &Answered, shown: &Shown<'_>, style: &Style) -> String {
    let Answered {
        scene,
        answer,
        effects,
        unweighed,
    } = answered;
    let mut text = String::new();
    if let Some(scene) = scene {
        let described = scene.described(shown.overrides);
        let line = format!("Scene {}: {described}.", scene.name);
        text += &wrapped(&line, style.width, 0);
    }
    let title = format!(
        "{} such that P({}) = {} (engine {}, {}):",
        name(&answer.question.key),
        answer.question.face.name(),
        target(answer.question.target),
        answer.engine,
        answer.law
    );
    text += &format!("{}\n", style.paint(Colors::Strong, &title));
    for curve in &answer.curves {
        text += &of_curve(answer, curve, shown, style);
    }
    if !effects.is_empty() {
        text += &assumptions(effects, style);
    }
    if *unweighed {
        text += "What it rests on is shown only where nothing is swept\n";
    }
    if style.unicode { text } else { in_ascii(&text) }
}

/// `H/R` for the ratio, else the key.
fn name(key: &str) -> &str {
    if key == "coin.ratio" { "H/R" } else { key }
}

fn target(p: f64) -> String {
    if p == 1.0 / 3.0 {
        "1/3".to_owned()
    } else {
        compact(p)
    }
}

fn of_curve(answer: &Fair, curve: &Curve, shown: &Shown<'_>, style: &Style) -> String {
    let mut text = String::new();
    if !curve.at.is_empty() {
        let at = curve
            .at
            .iter()
            .map(|(name, value)| format!("{name} = {}", compact(*value)));
        text += &format!("at {}:\n", at.collect::<Vec<_>>().join(", "));
    }
    for finding in &curve.findings {
        text += &match finding {
            Finding::Root(root) => of_root(answer, root, style) + &of_size(root, shown.other_size),
            Finding::Near { from, to } => format!(
                "    none seen, but P comes too near to the target to tell {}\n",
                stretch(*from, *to)
            ),
        };
    }
    if curve.findings.is_empty() {
        text += &nowhere(answer, curve);
    }
    if shown.search {
        text += &history(answer, curve, style);
    }
    text
}

/// Where the target lies outside of what was seen.
fn nowhere(answer: &Fair, curve: &Curve) -> String {
    let [least, most] = curve.extremes();
    let side = if most.p < answer.question.target {
        "below"
    } else {
        "above"
    };
    let at = |scanned: Scanned| {
        let p = scanned_p(&scanned);
        format!(
            "{p} at {}{}",
            compact(to_four(scanned.value)),
            by_tosses(scanned.tosses)
        )
    };
    format!(
        "    none: P stays {side} the target, between {} and {}\n",
        at(least),
        at(most)
    )
}

/// The probability at a value of the scan, with its interval if it has one.
fn scanned_p(scanned: &Scanned) -> String {
    let Scanned { p, lo, hi, .. } = *scanned;
    let arm = 0.5 * (hi - lo);
    if arm > 0.0 {
        let decimals = decimals_that_show(arm, 4);
        format!("{p:.decimals$} [{lo:.decimals$}, {hi:.decimals$}]")
    } else {
        format!("{p:.4}")
    }
}

fn by_tosses(n: u64) -> String {
    if n > 0 {
        format!(" ({})", tosses(n))
    } else {
        String::new()
    }
}

/// `from 1.5 to 2`, or `near 2` where the ends look the same.
fn stretch(from: f64, to: f64) -> String {
    match (compact(from), compact(to)) {
        (from, to) if from == to => format!("near {from}"),
        (from, to) => format!("from {from} to {to}"),
    }
}

/// To four decimals.
fn to_four(x: f64) -> f64 {
    libm::round(1e4 * x) / 1e4
}

fn of_root(answer: &Fair, root: &Root, style: &Style) -> String {
    let key = name(&answer.question.key);
    let arm = root.half_width();
    // a closed form has no error
    let decimals = if arm > 0.0 {
        decimals_that_show(arm, decimals_for(arm))
    } else {
        5
    };
    let number = |x: f64| format!("{x:.decimals$}");
    let end = |end: Option<f64>| end.map_or_else(|| "open".to_owned(), number);
    let mut text = format!("    {key} = {}", number(root.value));
    if arm.is_finite() && arm > 0.0 {
        text += &format!(" ± {arm:.decimals$}");
    }
    let percent = compact(100.0 * answer.confidence);
    let tosses = if answer.known {
        "without tosses".to_owned()
    } else {
        tosses(root.tosses)
    };
    text = style.paint(Colors::Strong, &text);
    let interval = if arm == 0.0 {
        "exact".to_owned()
    } else {
        format!("{percent} %: [{}, {}]", end(root.lo), end(root.hi))
    };
    text += &format!(
        "    {interval}, {tosses}{}\n",
        if root.reached {
            ""
        } else {
            ", short of the half width asked for"
        }
    );
    text += &slope(key, root);
    if let Some(numerical) = root.numerical {
        let decimals = decimals_that_show(0.5 * (numerical.hi - numerical.lo), 3);
        text += &format!(
            "    finer numerical settings move it by {} [{}, {}], {} pairs of tosses\n",
            signed(numerical.shift, decimals),
            signed(numerical.lo, decimals),
            signed(numerical.hi, decimals),
            grouped(numerical.tosses)
        );
    }
    if root.undecided > 0 {
        text += &format!(
            "    undecided: {}; the interval allows for any face of these tosses\n",
            grouped(root.undecided)
        );
    }
    text + &size(&root.coin, &answer.question.key, arm)
}

/// That the coin has not the config's diameter.
fn of_size(root: &Root, other_size: Option<OtherSize>) -> String {
    let remark = other_size.map_or(String::new(), |other| {
        other.remark(2.0 * root.coin.radius_m())
    });
    if remark.is_empty() {
        remark
    } else {
        format!("    {remark}")
    }
}

fn slope(key: &str, root: &Root) -> String {
    if root.is_on_plateau() {
        return format!("    a plateau: P hardly depends on {key} here\n");
    }
    let error = 1.96 * root.slope_error;
    let decimals = decimals_that_show(error, decimals_for(root.slope_error).min(4));
    let error = if error > 0.0 {
        format!(" ± {error:.decimals$}")
    } else {
        String::new()
    };
    format!("    dP/d({key}) = {:.decimals$}{error}\n", root.slope)
}

/// `a coin 23.25 mm in diameter is then 11.5 ± 0.06 mm thick`, if the parameter under this key is known to ± `arm`.
fn size(coin: &Coin, key: &str, arm: f64) -> String {
    let [diameter_error, thickness_error] = size_errors(coin, key, arm);
    let diameter = length(2.0 * coin.radius_m(), diameter_error);
    let thickness = length(coin.height_m(), thickness_error);
    format!("    a coin {diameter} mm in diameter is then {thickness} mm thick\n")
}

/// Errors of diameter and thickness, m, where the parameter is a length of the coin; else 0.
fn size_errors(coin: &Coin, key: &str, arm: f64) -> [f64; 2] {
    let key = key.strip_prefix("coin.").unwrap_or("");
    let unit = |keys: [(&str, f64); 4]| {
        keys.iter()
            .find(|(name, _)| *name == key)
            .map(|(_, unit)| *unit)
    };
    if key == "ratio" {
        return [0.0, arm * coin.radius_m()];
    }
    match (unit(Coin::RADII), unit(Coin::HEIGHTS)) {
        (Some(radius_m), _) => [2.0 * arm * radius_m, 0.0],
        (_, Some(height_m)) => [0.0, arm * height_m],
        _ => [0.0, 0.0],
    }
}

/// A length in mm, with its error if there is one that tells anything.
fn length(metres: f64, error_m: f64) -> String {
    let (length, error) = (1e3 * metres, 1e3 * error_m);
    if !(error > 0.0 && error < length) {
        return format!("{length:.2}");
    }
    let decimals = decimals_that_show(error, 2);
    format!("{length:.decimals$} ± {error:.decimals$}")
}

/// How the search went.
fn history(answer: &Fair, curve: &Curve, style: &Style) -> String {
    let key = name(&answer.question.key);
    let face = answer.question.face.name();
    let mut scan = Table::new(vec![
        Column::right(key),
        Column::left(format!("P({face})")),
        Column::right("tosses"),
    ]);
    for scanned in &curve.scan {
        scan.push(vec![
            compact(to_four(scanned.value)),
            scanned_p(scanned),
            grouped(scanned.tosses),
        ]);
    }
    let mut text = format!("Scan:\n{}", scan.render(style).text);
    for root in curve.roots().filter(|root| !root.rounds.is_empty()) {
        let mut rounds = Table::new(vec![
            Column::left("tossed between"),
            Column::right("tosses"),
            Column::right(key),
            Column::left(format!("{} % interval", compact(100.0 * answer.confidence))),
        ]);
        for round in &root.rounds {
            let decimals = decimals_for(round.half_width());
            let end =
                |end: Option<f64>| end.map_or("open".to_owned(), |x| format!("{x:.decimals$}"));
            rounds.push(vec![
                format!("{:.4} and {:.4}", round.from, round.to),
                grouped(round.tosses),
                format!("{:.decimals$}", round.value),
                format!("[{}, {}]", end(round.lo), end(round.hi)),
            ]);
        }
        text += &format!("Rounds:\n{}", rounds.render(style).text);
    }
    text
}

/// What the scene assumes, and how far each assumption moves the root.
fn assumptions(effects: &[Effect], style: &Style) -> String {
    let mut table = Table::new(vec![
        Column::left("assumed"),
        Column::right("is"),
        Column::left("may be"),
        Column::left("answer then"),
        Column::right("error"),
        Column::left("source").droppable(1),
    ]);
    for effect in effects {
        let assumption = &effect.assumption;
        let [low, high] = &effect.roots;
        table.push(vec![
            assumption.key.to_owned(),
            compact(assumption.value),
            format!("{} to {}", three(assumption.low), three(assumption.high)),
            format!("{:.2} to {:.2}", low.value, high.value),
            error_shown(low.half_width.max(high.half_width)),
            assumption.source.to_owned(),
        ]);
    }
    let title = style.paint(
        Colors::Strong,
        "What it rests on, and where the answer would be if that were otherwise:",
    );
    format!("{title}\n{}", table.render(style).text)
}

/// `± 0.02`, with more digits where that would read 0.
fn error_shown(error: f64) -> String {
    let decimals = decimals_that_show(error, 2);
    format!("± {error:.decimals$}")
}

/// To three digits.
fn three(x: f64) -> String {
    let rounded: f64 = format!("{x:.2e}").parse().unwrap_or(x);
    compact(rounded)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thickness_that_is_known_well_has_digits_for_its_error() {
        let coin = Coin::cylinder(0.918_345, 0.012).expect("a coin");
        let shown = |arm| size(&coin, "coin.ratio", arm);
        assert!(
            shown(0.003).contains("11.02 ± 0.04 mm thick"),
            "{}",
            shown(0.003)
        );
        assert!(
            shown(3e-6).contains("11.02014 ± 0.00004 mm"),
            "{}",
            shown(3e-6)
        );
        assert!(shown(0.0).contains("then 11.02 mm"), "{}", shown(0.0));
        assert_eq!(error_shown(0.004), "± 0.004");
    }

    #[test]
    fn a_length_that_was_searched_keeps_its_error() {
        let coin = Coin::cylinder(1.6681, 0.01).expect("a coin");
        let shown = |key, arm| size(&coin, key, arm);
        for (key, arm) in [
            ("coin.height_mm", 0.095),
            ("coin.thickness_m", 95e-6),
            ("coin.ratio", 0.0095),
        ] {
            let text = shown(key, arm);
            assert!(
                text.contains("20.00 mm in diameter is then 16.68 ± 0.10 mm thick")
                    || text.contains("16.68 ± 0.09 mm thick"),
                "{key}: {text}"
            );
        }
        let wide = shown("coin.diameter_mm", 0.25);
        assert!(
            wide.contains("a coin 20.00 ± 0.25 mm in diameter"),
            "{wide}"
        );
        let other = shown("launch.height_m", 0.25);
        assert!(!other.contains('±'), "{other}");
    }

    #[test]
    fn a_value_of_the_scan_has_its_interval_and_tosses() {
        let scanned = Scanned {
            value: 0.25,
            p: 0.002,
            lo: 0.0003,
            hi: 0.0141,
            tosses: 512,
        };
        assert_eq!(scanned_p(&scanned), "0.0020 [0.0003, 0.0141]");
        assert_eq!(by_tosses(512), " (512 tosses)");
        let known = Scanned {
            lo: 0.002,
            hi: 0.002,
            tosses: 0,
            ..scanned
        };
        assert_eq!(scanned_p(&known) + &by_tosses(0), "0.0020");
    }
}

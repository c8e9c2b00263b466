//! The verdicts as text.

use crate::terminal::table::{Column, Table};
use crate::terminal::{Colors, Style, compact, grouped, in_ascii, tosses, wrapped};
use coinmc_validate::{Checked, Evidence, Family, Line, Predicted, Validation, Verdict};

/// A p-value below this is told as such.
const LEAST_P: f64 = 1e-12;
/// Lines of a data set that are shown; the others have larger p-values.
const LINES: usize = 4;
/// Width of the verdict's condition.
const INDENT: usize = 4;

/// The whole result.
pub(super) fn text(found: &Validation, show: bool, style: &Style) -> String {
    let mut text = String::new();
    for (family, title) in [
        (Family::Paper, "Claims of Gaek & Sukhov, arXiv 2401.03557"),
        (
            Family::Engines,
            "Engines and laws against each other, on the same launches",
        ),
    ] {
        let claims = found.claims.iter();
        let claims: Vec<_> = claims
            .filter(|checked| checked.claim.family == family)
            .collect();
        if !claims.is_empty() {
            text += &format!("{}\n", style.paint(Colors::Strong, title));
            for checked in claims {
                text += &of_claim(checked, show, style);
            }
            text.push('\n');
        }
    }
    if !found.sets.is_empty() {
        text += &of_sets(found, show, style);
    }
    let text = text.trim_end().to_owned() + "\n";
    if style.unicode { text } else { in_ascii(&text) }
}

fn of_claim(checked: &Checked, show: bool, style: &Style) -> String {
    let Checked { claim, finding } = checked;
    let color = match finding.verdict {
        Verdict::Holds => Colors::Strong,
        Verdict::Rejected => Colors::Warning,
        Verdict::HoldsWhere(_) | Verdict::NotValidated(_) => Colors::Faint,
    };
    let name = style.paint(color, finding.verdict.name());
    let mut text = format!("{:14} {}: {name}\n", claim.name, claim.statement);
    if let Some(condition) = finding.verdict.condition() {
        text += &indented(condition, style);
    }
    if show && !finding.evidence.is_empty() {
        text += &of_evidence(&finding.evidence, style);
    } else if finding.tosses() > 0 {
        let made = style.paint(Colors::Faint, &tosses(finding.tosses()));
        text += &format!("{:INDENT$}{made}\n", "");
    }
    text
}

fn indented(words: &str, style: &Style) -> String {
    let width = style.width.saturating_sub(INDENT);
    format!("{:INDENT$}{}", "", wrapped(words, width, INDENT))
}

fn of_evidence(evidence: &[Evidence], style: &Style) -> String {
    let mut table = Table::new(vec![
        Column::left("    evidence"),
        Column::right("is"),
        Column::left("95 % interval"),
        Column::right("tosses"),
    ]);
    for number in evidence {
        let interval = number.interval.map_or(String::new(), |[lo, hi]| {
            format!("[{}, {}]", four(lo), four(hi))
        });
        let tosses = if number.tosses > 0 {
            grouped(number.tosses)
        } else {
            String::new()
        };
        table.push(vec![
            format!("    {}", number.what),
            four(number.value),
            interval,
            tosses,
        ]);
    }
    table
        .render(&Style {
            whole: true,
            ..*style
        })
        .text
}

/// Four decimals; a small number as a power of ten.
fn four(x: f64) -> String {
    if x == 0.0 || x.abs() >= 1e-3 {
        format!("{x:.4}")
    } else {
        format!("{x:.1e}")
    }
}

fn of_sets(found: &Validation, show: bool, style: &Style) -> String {
    let title = style.paint(Colors::Strong, "Public data sets, predicted by one prior");
    let mut text = format!("{title}\n");
    let mut table = Table::new(vec![
        Column::left("data set"),
        Column::left("number"),
        Column::right("published"),
        Column::right("of tosses").droppable(2),
        Column::right("predicted"),
        Column::left("95 % of draws").droppable(1),
        Column::right("p-value"),
    ]);
    for set in found.predicted() {
        let shown = if show { set.lines.len() } else { LINES };
        let mut lines: Vec<&Line> = set.lines.iter().collect();
        if lines.len() > shown {
            lines.sort_by(|a, b| a.p_value.total_cmp(&b.p_value));
        }
        table.push(of_set(set));
        for line in lines.iter().take(shown) {
            table.push(of_line(line));
        }
        if lines.len() > shown {
            table.push_gap((lines.len() - shown) as u64);
        }
    }
    text += &table.render(style).text;
    let percent = compact(100.0 * Validation::LEVEL);
    let all = found.predicted().count();
    if all > 0 {
        text += &format!(
            "{} of {all} predicted sets are not rejected at {percent} %\n",
            found.not_rejected()
        );
        let prior = format!(
            "Prior: {}. {} draws, {} tosses of each coin by each. The p-value of a set is the smallest of its lines times their \
             number; ± is its standard error from the number of draws.",
            Validation::prior(),
            grouped(found.draws),
            grouped(found.tosses_of_draw)
        );
        text += &wrapped(&prior, style.width, 0);
    }
    text + &not_validated(found, style)
}

fn of_set(set: &Predicted) -> Vec<String> {
    let p = set.p_value.map_or(String::new(), |p| {
        let rejected = if set.is_rejected(Validation::LEVEL) == Some(true) {
            "rejected, "
        } else {
            ""
        };
        format!("{rejected}{}", p_value(p, set.p_error))
    });
    let blank = || String::new();
    let doc = set.set.doc.to_owned();
    vec![
        set.set.name.to_owned(),
        doc,
        blank(),
        blank(),
        blank(),
        blank(),
        p,
    ]
}

fn of_line(line: &Line) -> Vec<String> {
    let tosses = if line.tosses > 0 {
        grouped(line.tosses)
    } else {
        String::new()
    };
    let [lo, hi] = line.range;
    let number = if line.name.is_empty() {
        line.quantity.to_owned()
    } else {
        format!("{}, {}", line.quantity, line.name)
    };
    vec![
        String::new(),
        number,
        four(line.seen),
        tosses,
        four(line.predicted),
        format!("[{}, {}]", four(lo), four(hi)),
        p_value(line.p_value, line.p_error),
    ]
}

fn p_value(p: f64, error: f64) -> String {
    let number = if p < LEAST_P {
        return format!("< {LEAST_P:e}");
    } else if p < 1e-3 {
        format!("{p:.1e}")
    } else {
        format!("{p:.3}")
    };
    // a product with the number of lines is at most 1
    if error >= 5e-4 && p < 1.0 {
        format!("{number} ± {error:.3}")
    } else {
        number
    }
}

fn not_validated(found: &Validation, style: &Style) -> String {
    let mut text = String::new();
    for set in &found.sets {
        if let Some(why) = set.why_not() {
            let words = format!(
                "{}: {} ({}): {why}",
                set.set.name, set.set.doc, set.set.source
            );
            text += &indented(&words, style);
        }
    }
    if text.is_empty() {
        return text;
    }
    format!("{}\n{text}", style.paint(Colors::Strong, "Not validated"))
}

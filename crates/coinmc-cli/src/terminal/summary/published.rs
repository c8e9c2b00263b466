//! Our P(side) beside the published counts of the same launch and ratio.

use super::totals::Totals;
use super::{probability, shown_parameters};
use crate::terminal::table::{Column, Table};
use crate::terminal::{Colors, Style, compact, decimals_for, grouped, wrapped};
use coinmc::published::{Published, TABLE1_SOURCE};
use coinmc::results::{Results, Row};

/// More points than this are not listed; JSON has them all.
pub(super) const MOST: usize = 20;

/// Why the two differ however many tosses are made: 50 rad/s · 0.02 s = 1 rad.
const CAVEAT: &str =
    "Agreement is not to be expected: Unity's 0.02 s step at 50 rad/s (1 rad) is not converged.";

/// A row for each point with published counts, and why they are not ours. `None` if there is none.
pub(super) fn table(results: &Results, totals: &Totals, style: &Style) -> Option<String> {
    if totals.published.is_empty() {
        return None;
    }
    let shown = shown_parameters(results);
    let mut columns: Vec<Column> = shown.iter().map(|name| Column::right(*name)).collect();
    columns.extend([
        Column::right("P(side)"),
        Column::right("published"),
        Column::right("side of tosses").droppable(1),
        Column::right("z"),
    ]);
    let mut table = Table::new(columns);
    let decimals = totals.decimals;
    for row in &totals.published {
        let parameter = |name: &&str| row.parameter(name).map_or("-".to_owned(), compact);
        let mut cells: Vec<String> = shown.iter().map(parameter).collect();
        cells.push(probability(&row.side, row, decimals, style));
        let published = row.published.as_ref();
        cells.extend(
            published
                .into_iter()
                .flat_map(|found| theirs(row, found, decimals)),
        );
        table.push(cells);
    }
    if totals.published_points > MOST as u64 {
        table.push_gap(totals.published_points - MOST as u64);
    }
    let title = wrapped(
        &format!("Published for this launch ({TABLE1_SOURCE}):"),
        style.width,
        4,
    );
    let title = style.paint(Colors::Strong, title.trim_end());
    let mut text = format!("{title}\n{}", table.render(style).text);
    text += &differences(&totals.differs, style);
    text += &wrapped(CAVEAT, style.width, 4);
    Some(text)
}

/// Published share, its counts, and how many standard errors ours lies above it.
fn theirs(row: &Row, published: &Published, decimals: usize) -> [String; 3] {
    let counts = &published.counts;
    let z = counts.z_score(row.tally.side, row.tally.tosses());
    // one count in thousands is not 0
    let share = counts.p_side();
    let decimals = decimals.max(if share > 0.0 {
        decimals_for(share) - 1
    } else {
        0
    });
    [
        format!("{share:.decimals$}"),
        format!("{} of {}", grouped(counts.side), grouped(counts.tosses())),
        z.map_or("-".to_owned(), |z| format!("{z:+.1}")),
    ]
}

/// The keys in which the scene differs, if any.
fn differences(keys: &[&str], style: &Style) -> String {
    if keys.is_empty() {
        return String::new();
    }
    let text = format!(
        "Not the published scene, it differs in: {}.",
        keys.join(", ")
    );
    wrapped(&text, style.width, 4)
}

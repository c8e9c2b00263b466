//! Our P(side) beside the published counts of the same launch and ratio.

use super::{decimals, probability, shown_parameters};
use crate::terminal::table::{Column, Table};
use crate::terminal::{Colors, Style, compact, decimals_for, grouped, wrapped};
use coinmc::published::{Published, TABLE1_SOURCE};
use coinmc::results::{Results, Row};

/// More points than this are not listed; JSON has them all.
const MOST: usize = 20;

/// Why the two differ however many tosses are made: 50 rad/s · 0.02 s = 1 rad.
const CAVEAT: &str =
    "Agreement is not to be expected: Unity's 0.02 s step at 50 rad/s (1 rad) is not converged.";

/// A row for each point with published counts, and why they are not ours. `None` if there is none.
pub(super) fn table(results: &Results, style: &Style) -> Option<String> {
    let rows: Vec<(&Row, &Published)> = results
        .rows
        .iter()
        .filter_map(|row| Some((row, row.published.as_ref()?)))
        .collect();
    if rows.is_empty() {
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
    let decimals = decimals(results);
    for (row, published) in rows.iter().take(MOST) {
        let parameter = |name: &&str| row.parameter(name).map_or("-".to_owned(), compact);
        let mut cells: Vec<String> = shown.iter().map(parameter).collect();
        cells.push(probability(&row.side, row, decimals, style));
        cells.extend(theirs(row, published, decimals));
        table.push(cells);
    }
    if rows.len() > MOST {
        table.push_gap((rows.len() - MOST) as u64);
    }
    let title = wrapped(
        &format!("Published for this launch ({TABLE1_SOURCE}):"),
        style.width,
        4,
    );
    let title = style.paint(Colors::Strong, title.trim_end());
    let mut text = format!("{title}\n{}", table.render(style).text);
    text += &differences(&rows, style);
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
fn differences(rows: &[(&Row, &Published)], style: &Style) -> String {
    let mut keys: Vec<&str> = Vec::new();
    for key in rows.iter().flat_map(|(_, published)| &published.differs) {
        if !keys.contains(key) {
            keys.push(key);
        }
    }
    if keys.is_empty() {
        return String::new();
    }
    let text = format!(
        "Not the published scene, it differs in: {}.",
        keys.join(", ")
    );
    wrapped(&text, style.width, 4)
}

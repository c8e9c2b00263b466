//! One toss as text: its events in a table, and what decided the face.

mod decision;
mod rows;

use super::table::{Column, Table};
use super::{Colors, Style, compact, count, in_ascii, wrapped};
use coinmc_trace::Trace;
use rows::{Line, Row, lines};

/// The events of a toss and why it ended. Long series of small bounces share one line unless `all`
/// is set.
pub(crate) fn events(trace: &Trace, all: bool, style: &Style) -> String {
    let mut table = Table::new(vec![
        Column::right("time, s"),
        Column::left("event"),
        Column::left("motion").droppable(4),
        Column::right("height, m").droppable(3),
        Column::right("energy, J/kg").droppable(6),
        Column::right("of balance"),
        Column::right("turns/s").droppable(2),
        Column::left("up").droppable(1),
        Column::right("tilt, °"),
        Column::right("rim, m/s").droppable(5),
    ]);
    let rows = rows::rows(trace);
    let decimals = decimals(trace.duration_s());
    for line in lines(&rows, trace.scene.time_scale_s(), all) {
        match line {
            Line::Row(row) => table.push(cells(row, decimals)),
            Line::Group(rows) => table.push_note(&grouped(rows)),
            Line::Hidden(rows) => {
                let hidden = count(rows.len() as u64, "more event");
                table.push_note(&format!("{hidden}, which --all shows"));
            }
        }
    }
    let table = table.render(style).text;
    let mut text = style.paint(Colors::Strong, &title(trace)) + "\n\n" + &table;
    if let Some(until) = trace.events_until_s {
        let last = compact(until);
        let note = format!("Events after {last} s, except for the end, were too many to record.");
        text += &format!("{}\n", style.paint(Colors::Faint, &note));
    }
    text += "\n";
    text += &wrapped(&decision::decision(trace), style.width, 0);
    if style.unicode { text } else { in_ascii(&text) }
}

/// "Toss 17 of point 3, flat engine: H/R 1.2, R 0.01 m, e 0.5, μ 0.3"
fn title(trace: &Trace) -> String {
    let (coin, surface) = (&trace.scene.coin, &trace.scene.surface);
    format!(
        "Toss {} of point {}, {} engine: H/R {}, R {} m, e {}, μ {}",
        trace.toss,
        trace.point,
        trace.engine,
        compact(coin.ratio()),
        compact(coin.radius_m()),
        compact(surface.restitution()),
        compact(surface.friction()),
    )
}

/// Decimals of a time that resolve a ten-thousandth of the toss, at least 4.
fn decimals(duration_s: f64) -> usize {
    let mut decimals = 4;
    let mut unit = 1.0;
    while duration_s < unit && decimals < 12 {
        unit /= 10.0;
        decimals += 1;
    }
    decimals
}

fn cells(row: &Row, decimals: usize) -> Vec<String> {
    vec![
        format!("{:.decimals$}", row.time_s),
        row.event.clone(),
        row.goes_on.to_owned(),
        three_digits(row.height_m),
        three_digits(row.energy_j_kg),
        three_digits(row.of_balance),
        three_digits(row.turns_s),
        row.up.to_owned(),
        format!("{:.1}", row.tilt_deg),
        row.rim_m_s.map_or(String::new(), three_digits),
    ]
}

/// Three decimals, or more if these would show fewer than three digits.
fn three_digits(x: f64) -> String {
    let size = x.abs();
    if x == 0.0 || (0.1..1e6).contains(&size) {
        format!("{x:.3}")
    } else if (1e-4..0.1).contains(&size) {
        format!("{x:.5}")
    } else {
        format!("{x:.2e}")
    }
}

/// "41 impacts in 3.1 ms"
fn grouped(rows: &[Row]) -> String {
    let impacts = rows.iter().filter(|row| row.is_impact).count() as u64;
    let others = rows.len() as u64 - impacts;
    let mut parts = Vec::new();
    if impacts > 0 {
        parts.push(count(impacts, "impact"));
    }
    if others > 0 {
        parts.push(count(others, "change") + " of contact");
    }
    let time = match rows {
        [first, .., last] => last.time_s - first.time_s,
        _ => 0.0,
    };
    format!("{} in {} ms", parts.join(" and "), three_digits(1e3 * time))
}

#[cfg(test)]
mod tests;

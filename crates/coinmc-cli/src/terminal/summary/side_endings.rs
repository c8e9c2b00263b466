//! How tosses that ended on the side came there, in one sentence.

use crate::terminal::grouped;
use coinmc_core::{ROLL_BOUNDS_M, Tally};

/// The sentence for all points together; `None` if no engine knows.
pub(super) fn sentence(sum: &Tally) -> Option<String> {
    let known = sum.side_rested + sum.side_rolled + sum.side_spun;
    if known == 0 {
        return None;
    }
    let share = |count: u64| format!("{:.1} %", 100.0 * count as f64 / known as f64);
    let mut sentence = format!(
        "On the side: {} tosses, {} came to rest where they landed, {} rolled, {} spun",
        grouped(known),
        share(sum.side_rested),
        share(sum.side_rolled),
        share(sum.side_spun)
    );
    if let Some((bound, count)) = farthest(sum) {
        sentence += &format!("; {} rolled more than {bound}", share(count));
    }
    Some(sentence)
}

/// The largest bound that half of those that rolled passed, and how many passed it.
fn farthest(sum: &Tally) -> Option<(String, u64)> {
    let passed = ROLL_BOUNDS_M.into_iter().zip(sum.rolled()).rev();
    let mut half = passed.filter(|(_, count)| *count > 0 && *count >= sum.side_rolled.div_ceil(2));
    half.next().map(|(bound, count)| (length(bound), count))
}

/// A whole number of metres or centimetres.
fn length(metres: f64) -> String {
    if metres < 1.0 {
        format!("{:.0} cm", 100.0 * metres)
    } else {
        format!("{metres:.0} m")
    }
}

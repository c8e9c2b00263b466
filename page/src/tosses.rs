//! Counts of tosses, and the probabilities that they tell.

use crate::Answer;
use crate::check::plan;
use coinmc::run::{Chunk, run_chunk};
use coinmc_core::{Estimate, Face, Tally};
use serde_json::{Map, json};
use std::collections::BTreeMap;
use std::ops::Range;

pub(crate) fn toss(config: &str, point: usize, tosses: Range<u64>) -> Answer {
    let plan = plan(config)?;
    let chunk = Chunk { point, tosses };
    let tally = run_chunk(&plan, &chunk).map_err(|error| error.to_string())?;
    if tally.tosses() == 0 && !chunk.tosses.is_empty() {
        return Err("a closed form answers this config: there is nothing to toss".to_owned());
    }
    let counts = Tally::COUNTERS.iter().zip(tally.to_array());
    let counts = counts.map(|(counter, count)| (counter.name.to_owned(), json!(count)));
    Ok(json!({ "tally": counts.collect::<Map<_, _>>() }))
}

pub(crate) fn estimate(config: &str, counts: &BTreeMap<String, u64>) -> Answer {
    let plan = plan(config)?;
    let tally = tally(counts)?;
    let of = |face: Face| {
        Estimate::new(
            tally.count(face),
            tally.undecided(),
            tally.tosses(),
            plan.confidence,
            plan.interval,
        )
    };
    let faces = Face::ALL.map(|face| {
        let Estimate { p, lo, hi, .. } = of(face);
        (
            face.name().to_owned(),
            json!({ "p": p, "lo": lo, "hi": hi }),
        )
    });
    Ok(json!({
        "tosses": tally.tosses(),
        "undecided": tally.undecided(),
        "left": tally.left,
        "confidence": plan.confidence,
        "faces": Map::from_iter(faces),
    }))
}

/// More tosses than a page can make; sums of counters below it fit.
const MOST: u64 = 1 << 53;

fn tally(counts: &BTreeMap<String, u64>) -> Result<Tally, String> {
    let unknown = |name: &&String| !Tally::COUNTERS.iter().any(|known| known.name == **name);
    if let Some(name) = counts.keys().find(unknown) {
        return Err(format!("a tally has no count `{name}`"));
    }
    if counts.values().any(|&count| count > MOST) {
        return Err(format!("a count is at most {MOST}"));
    }
    let of = |name: &str| counts.get(name).copied().unwrap_or(0);
    Ok(Tally::from_array(
        Tally::COUNTERS.map(|counter| of(counter.name)),
    ))
}

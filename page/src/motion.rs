//! One toss to draw.

use crate::Answer;
use crate::check::plan;
use coinmc_trace::{Record, RecordKind, default_rate_hz, launch, outcome_name, replay_within};
use serde_json::{Value, json};

/// Records kept while a toss is repeated; longer tosses are shown as far as that.
const MOST_RECORDS: usize = 200_000;

pub(crate) fn motion(config: &str, point: usize, toss: u64, most: usize) -> Answer {
    let plan = plan(config)?;
    let text = |error: coinmc_trace::TraceError| error.to_string();
    let launch = launch(&plan, point, toss).map_err(text)?;
    let scene = &plan.points[point].scene;
    let rate = default_rate_hz(scene, &launch);
    let trace = replay_within(&plan, point, toss, rate, MOST_RECORDS).map_err(text)?;
    let coin = &scene.coin;
    // of the samples as many as there is room for; events too, so that no bounce is cut off
    let room = most.clamp(2, MOST_RECORDS);
    let step = trace.records.len().div_ceil(room).max(1);
    let is_event = |record: &Record| record.kind != RecordKind::Sample;
    let events_fit = trace.records.iter().filter(|r| is_event(r)).count() <= room;
    let last = trace.records.len().saturating_sub(1);
    let drawn = trace
        .records
        .iter()
        .enumerate()
        .filter(|(i, record)| i % step == 0 || *i == last || (events_fit && is_event(record)));
    let states: Vec<Value> = drawn.map(|(_, record)| state(record)).collect();
    let events = trace.records.iter().filter_map(|record| match record.kind {
        RecordKind::Event(_) => Some(json!([record.state.time_s, record.kind.name()])),
        RecordKind::Sample => None,
    });
    Ok(json!({
        "toss": toss,
        "outcome": outcome_name(&trace.outcome),
        "impacts": trace.outcome.impacts,
        "duration_s": trace.duration_s(),
        "radius_m": coin.radius_m(),
        "height_m": coin.height_m(),
        // time, centre, orientation (w, x, y, z), energy per mass
        "states": states,
        "events": events.take(room).collect::<Vec<_>>(),
    }))
}

fn state(record: &Record) -> Value {
    let (place, q) = (&record.state.position_m, record.orientation.quaternion());
    json!([
        record.state.time_s,
        place.x,
        place.y,
        place.z,
        q.w,
        q.i,
        q.j,
        q.k,
        record.energy_j_kg,
    ])
}

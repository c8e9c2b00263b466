//! A toss for the page: coin, ground, keyframes and events.

use crate::keyframes::keyframes;
use crate::motion::axial_factor;
use coinmc::plan::Plan;
use coinmc_core::{EventKind, Scene};
use coinmc_trace::{Mode, Record, RecordKind, Trace, outcome_name};
use serde_json::{Value, json};

/// Names of the kinds of records, in the order of their codes in the page.
pub(crate) const KINDS: [&str; 8] = [
    "sample", "launched", "touching", "impact", "sticking", "sliding", "lift_off", "ended",
];

/// A toss with its scene, and the parameters of these names.
pub(crate) fn toss(plan: &Plan, trace: &Trace, names: &[String]) -> Value {
    json!({
        "name": format!("toss {}", trace.toss),
        "at": at(plan, trace.point, names),
        "point": trace.point,
        "toss": trace.toss,
        "engine": trace.engine,
        "outcome": outcome_name(&trace.outcome),
        "impacts": trace.outcome.impacts,
        "complete": trace.samples_until_s.is_none() && trace.events_until_s.is_none(),
        "scene": scene(&trace.scene),
        "keys": keys(trace),
    })
}

/// The parameters of a point that have these names.
pub(crate) fn at(plan: &Plan, point: usize, names: &[String]) -> Value {
    let parameters = plan.points[point].parameters.iter();
    let told = parameters.filter(|(name, _)| names.iter().any(|told| **told == **name));
    told.map(|(name, value)| json!([**name, value])).collect()
}

/// What the page draws and computes with.
pub(crate) fn scene(scene: &Scene) -> Value {
    let coin = &scene.coin;
    json!({
        "radius_m": coin.radius_m(),
        "height_m": coin.height_m(),
        "rim_radius_m": coin.rim_radius_m(),
        "axial_gyration_m2": coin.axial_gyration_m2(),
        "transverse_gyration_m2": coin.transverse_gyration_m2(),
        "axial_factor": axial_factor(scene),
        "gravity_m_s2": scene.gravity_m_s2(),
        "linear_drag_per_s": scene.drag().linear_per_s(),
        "angular_drag_per_s": scene.drag().angular_per_s(),
        "table_radius_m": scene.surface.table_radius_m(),
    })
}

/// The keyframes: times, kinds, modes, and thirteen numbers each, one after the other: centre, orientation (w,
/// x, y, z), velocity, angular velocity.
pub(crate) fn keys(trace: &Trace) -> Value {
    let kept = keyframes(trace);
    let records: Vec<&Record> = kept.iter().map(|&i| &trace.records[i]).collect();
    let numbers = records.iter().flat_map(|record| numbers(record));
    json!({
        "time_s": records.iter().map(|r| rounded(r.state.time_s, 9)).collect::<Vec<_>>(),
        "kind": records.iter().map(|r| kind(r)).collect::<Vec<_>>(),
        "mode": records.iter().map(|r| mode(r)).collect::<Vec<_>>(),
        "numbers": numbers.map(|x| rounded(x, 7)).collect::<Vec<_>>(),
    })
}

fn numbers(record: &Record) -> [f64; 13] {
    let (p, q) = (&record.state.position_m, &record.orientation);
    let (v, w) = (&record.state.velocity_m_s, &record.state.spin_rad_s);
    [
        p.x, p.y, p.z, q.w, q.i, q.j, q.k, v.x, v.y, v.z, w.x, w.y, w.z,
    ]
}

fn kind(record: &Record) -> usize {
    let name = record.kind.name();
    KINDS.iter().position(|known| *known == name).unwrap_or(0)
}

fn mode(record: &Record) -> usize {
    Mode::ALL
        .iter()
        .position(|mode| *mode == record.mode)
        .unwrap_or(0)
}

/// So many digits, which no picture can tell from the number itself, in fewer characters.
fn rounded(x: f64, digits: usize) -> f64 {
    if !x.is_finite() {
        return 0.0;
    }
    format!("{x:.*e}", digits - 1).parse().unwrap_or(x)
}

/// Whether a record is an impact.
pub(crate) fn is_impact(record: &Record) -> bool {
    record.kind == RecordKind::Event(EventKind::Impact)
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_core::EventKind as E;

    #[test]
    fn every_kind_of_record_has_a_code() {
        let events = [
            E::Launched,
            E::Touching,
            E::Impact,
            E::Sticking,
            E::Sliding,
            E::LiftOff,
            E::Ended,
        ];
        let kinds = events
            .map(RecordKind::Event)
            .into_iter()
            .chain([RecordKind::Sample]);
        for kind in kinds {
            assert!(KINDS.contains(&kind.name()), "{}", kind.name());
        }
    }

    #[test]
    fn numbers_are_rounded_to_digits_not_to_decimals() {
        assert_eq!(rounded(1.234_567_891_2e-9, 7), 1.234_568e-9);
        assert_eq!(rounded(-12_345_678.9, 3), -1.23e7);
        assert_eq!((rounded(0.0, 7), rounded(f64::NAN, 7)), (0.0, 0.0));
    }
}

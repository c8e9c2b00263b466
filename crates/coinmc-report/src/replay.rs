//! A toss for the page: coin, ground, keyframes and events.

use crate::keyframes::{Fineness, keyframes};
use crate::motion::axial_factor;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
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
        "keys": keys(trace, Fineness::FINE),
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
    let rims = coin.rims().map(|rim| [rim.radius_m, rim.distance_m]);
    json!({
        "radius_m": coin.radius_m(),
        "height_m": coin.height_m(),
        "rim_radius_m": coin.rim_radius_m(),
        // radius and distance from the centre of mass, of heads and tails
        "rims_m": (!coin.has_like_faces()).then_some(rims),
        "axial_gyration_m2": coin.axial_gyration_m2(),
        "transverse_gyration_m2": coin.transverse_gyration_m2(),
        "axial_factor": axial_factor(scene),
        "weight_m_s2": scene.weight_m_s2().as_slice(),
        "linear_drag_per_s": scene.drag().linear_per_s(),
        "angular_drag_per_s": scene.drag().angular_per_s(),
        "table_radius_m": scene.surface.table_radius_m(),
    })
}

/// The keyframes: times, kinds and modes (a digit each), and [`NUMBERS`] numbers each, one after the other:
/// centre, orientation (w, x, y, z), velocity, angular velocity. Coarse ones are packed, see [`packed`].
pub(crate) fn keys(trace: &Trace, fineness: Fineness) -> Value {
    let kept = keyframes(trace, fineness);
    let records: Vec<&Record> = kept.iter().map(|&i| &trace.records[i]).collect();
    let numbers: Vec<[f64; NUMBERS]> = records.iter().map(|record| numbers(record)).collect();
    let numbers = if fineness.all_events {
        json!(
            numbers
                .as_flattened()
                .iter()
                .map(|&x| rounded(x, 7))
                .collect::<Vec<_>>()
        )
    } else {
        packed(&numbers)
    };
    json!({
        "time_s": records.iter().map(|r| rounded(r.state.time_s, 9)).collect::<Vec<_>>(),
        "kind": records.iter().map(|r| digit(kind(r))).collect::<String>(),
        "mode": records.iter().map(|r| digit(mode(r))).collect::<String>(),
        "numbers": numbers,
    })
}

/// Numbers of a keyframe.
const NUMBERS: usize = 13;

/// Each number as a share, in 65 535ths, of the range of its kind: 16 bits each, the lower byte first, as
/// base64; with the least of each kind and the size of a step.
fn packed(numbers: &[[f64; NUMBERS]]) -> Value {
    let mut least = [f64::INFINITY; NUMBERS];
    let mut most = [f64::NEG_INFINITY; NUMBERS];
    for row in numbers {
        for (i, x) in row.iter().enumerate() {
            (least[i], most[i]) = (least[i].min(*x), most[i].max(*x));
        }
    }
    let steps: Vec<f64> = (0..NUMBERS)
        .map(|i| rounded((most[i] - least[i]) / 65_535.0, 9))
        .collect();
    let mut bytes = Vec::with_capacity(numbers.len() * NUMBERS * 2);
    for row in numbers {
        for (i, x) in row.iter().enumerate() {
            let share = if steps[i] > 0.0 {
                (x - least[i]) / steps[i]
            } else {
                0.0
            };
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // from 0 to 65 535
            let share = libm::round(share.clamp(0.0, 65_535.0)) as u16;
            bytes.extend(share.to_le_bytes());
        }
    }
    json!({ "least": least, "steps": steps, "data": STANDARD.encode(bytes) })
}

fn digit(code: usize) -> char {
    u32::try_from(code)
        .ok()
        .and_then(|code| char::from_digit(code, 10))
        .unwrap_or('0')
}

fn numbers(record: &Record) -> [f64; NUMBERS] {
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

    /// What the page reads: least + step · share, within half a step of the number.
    #[test]
    fn packed_numbers_are_within_half_a_step() {
        let row = |x: f64| std::array::from_fn(|i| x * (i as f64 - 6.0) + 0.25);
        let rows = [row(0.0), row(1.0), row(-0.37), row(0.123)];
        let told = packed(&rows);
        let bytes = STANDARD.decode(told["data"].as_str().unwrap()).unwrap();
        for (place, x) in rows.as_flattened().iter().enumerate() {
            let share = u16::from_le_bytes([bytes[2 * place], bytes[2 * place + 1]]);
            let of = |key: &str| told[key][place % NUMBERS].as_f64().unwrap();
            let read = of("least") + of("steps") * f64::from(share);
            assert!((read - x).abs() <= 0.51 * of("steps"), "{read} {x}");
        }
    }

    #[test]
    fn numbers_are_rounded_to_digits_not_to_decimals() {
        assert_eq!(rounded(1.234_567_891_2e-9, 7), 1.234_568e-9);
        assert_eq!(rounded(-12_345_678.9, 3), -1.23e7);
        assert_eq!((rounded(0.0, 7), rounded(f64::NAN, 7)), (0.0, 0.0));
    }
}

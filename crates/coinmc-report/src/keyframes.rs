//! Which records of a trace a page keeps: every event, and of the samples those without which the motion
//! between keyframes would be visibly another.

use crate::motion::between;
use coinmc_core::Scene;
use coinmc_trace::{Record, RecordKind, Trace};
use nalgebra::Vector3;

/// Largest error of the direction of the coin's axis, rad: a quarter of a degree.
const MOST_TURN: f64 = 0.25 * std::f64::consts::PI / 180.0;
/// Largest error of the centre, in distances from the centre to the rim.
const MOST_SHIFT: f64 = 0.004;

/// The numbers of the records to keep, in order.
pub(crate) fn keyframes(trace: &Trace) -> Vec<usize> {
    let records = &trace.records;
    let is_event = |i: &usize| matches!(records[*i].kind, RecordKind::Event(_));
    let events: Vec<usize> = (0..records.len()).filter(is_event).collect();
    let mut kept = events.clone();
    // stretches between events, and parts of them, in which no sample is kept yet
    let mut stretches: Vec<(usize, usize)> = events.windows(2).map(|w| (w[0], w[1])).collect();
    while let Some((from, to)) = stretches.pop() {
        if let Some(worst) = worst(&trace.scene, records, from, to) {
            kept.push(worst);
            stretches.extend([(from, worst), (worst, to)]);
        }
    }
    kept.sort_unstable();
    kept
}

/// The sample that the motion between two records misses most; `None` if it meets all.
fn worst(scene: &Scene, records: &[Record], from: usize, to: usize) -> Option<usize> {
    let (a, b) = (&records[from], &records[to]);
    let h = b.state.time_s - a.state.time_s;
    let size = scene.coin.rim_distance_m();
    let miss = |i: usize| {
        let record = &records[i];
        let (place, turn) = between(scene, a, b, (record.state.time_s - a.state.time_s) / h);
        let axis = turn * Vector3::z();
        let turned = axis.cross(&record.state.axis).norm();
        // a quarter turn or more is as bad as any
        let turned = if axis.dot(&record.state.axis) < 0.0 {
            1.0
        } else {
            turned
        };
        let shifted = (place - record.state.position_m).norm() / size;
        (turned / MOST_TURN).max(shifted / MOST_SHIFT)
    };
    let misses = (from + 1..to).map(|i| (i, miss(i)));
    let (worst, error) = misses.max_by(|a, b| a.1.total_cmp(&b.1))?;
    (error > 1.0).then_some(worst)
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_trace::replay;

    /// Tosses in the plane and in space, with drag, that end on a face or roll on the side.
    fn traces() -> Vec<Trace> {
        let scenes = [
            ("engine.flat = {}", "launch.preset = 'robot'"),
            ("engine.volumetric = {}", "launch.preset = 'clean'"),
            (
                "engine.volumetric = {}\nenvironment = { linear_drag_per_s = 1, angular_drag_per_s = 0.5 }",
                "launch.preset = 'table1'",
            ),
            (
                "engine.volumetric = {}\nenvironment.gyroscopic_torque = false",
                "launch.preset = 'clean'",
            ),
        ];
        let mut traces = vec![];
        for (engine, launch) in scenes {
            let config = format!(
                "coin.ratio = 0.8\nsurface = {{ restitution = 0.5, friction = 0.3 }}\n{launch}\n{engine}\n\
                 stop.tosses = 100"
            );
            let plan =
                coinmc::config::parse("test", &config, &[]).unwrap_or_else(|e| panic!("{e}"));
            traces.extend((0..10).map(|toss| replay(&plan, 0, toss, 1000.0).unwrap()));
        }
        traces
    }

    /// Every sample, kept or not, is met by the motion between keyframes, and flights need none of them.
    #[test]
    fn the_motion_between_keyframes_meets_all_samples() {
        let (mut all, mut kept) = (0, 0);
        for trace in traces() {
            let keys = keyframes(&trace);
            (all, kept) = (all + trace.records.len(), kept + keys.len());
            for pair in keys.windows(2) {
                assert_eq!(worst(&trace.scene, &trace.records, pair[0], pair[1]), None);
                let samples = pair[1] - pair[0] - 1;
                let from = &trace.records[pair[0]];
                assert!(samples == 0 || from.state.time_s < trace.records[pair[1]].state.time_s);
            }
            let in_flight = keys.iter().filter(|&&i| {
                trace.records[i].kind == RecordKind::Sample
                    && trace.records[i].mode == coinmc_trace::Mode::Flight
            });
            assert_eq!(in_flight.count(), 0, "the closed form of flight is exact");
        }
        assert!(kept * 8 < all, "{kept} of {all}");
    }
}

//! Which records of a trace a page keeps: events, and of the samples those without which the motion
//! between keyframes would be visibly another.

use crate::motion::between;
use coinmc_core::Scene;
use coinmc_trace::{Record, RecordKind, Trace};
use nalgebra::Vector3;

/// How closely the motion between keyframes follows the records.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Fineness {
    /// Largest error of the direction of the coin's axis, rad.
    turn: f64,
    /// Largest error of the centre, in distances from the centre to the rim.
    shift: f64,
    /// Whether every event is kept, or only those that the motion needs.
    pub(crate) all_events: bool,
}

impl Fineness {
    /// For a toss to look at closely: a quarter of a degree.
    pub(crate) const FINE: Self = Self {
        turn: 0.25 * std::f64::consts::PI / 180.0,
        shift: 0.004,
        all_events: true,
    };
    /// For hundreds of tosses in one page: two degrees.
    pub(crate) const COARSE: Self = Self {
        turn: 2.0 * std::f64::consts::PI / 180.0,
        shift: 0.03,
        all_events: false,
    };
}

/// The numbers of the records to keep, in order.
pub(crate) fn keyframes(trace: &Trace, fineness: Fineness) -> Vec<usize> {
    let records = &trace.records;
    let last = records.len().saturating_sub(1);
    let is_kept = |i: &usize| {
        let is_event = matches!(records[*i].kind, RecordKind::Event(_));
        is_event && fineness.all_events || *i == 0 || *i == last
    };
    let events: Vec<usize> = (0..records.len()).filter(is_kept).collect();
    let mut kept = events.clone();
    // stretches between those, and parts of them, in which no record is kept yet
    let mut stretches: Vec<(usize, usize)> = events.windows(2).map(|w| (w[0], w[1])).collect();
    while let Some((from, to)) = stretches.pop() {
        if let Some(worst) = worst(&trace.scene, records, from, to, fineness) {
            kept.push(worst);
            stretches.extend([(from, worst), (worst, to)]);
        }
    }
    kept.sort_unstable();
    kept
}

/// The record that the motion between two records misses most; `None` if it meets all.
fn worst(
    scene: &Scene,
    records: &[Record],
    from: usize,
    to: usize,
    fineness: Fineness,
) -> Option<usize> {
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
        (turned / fineness.turn).max(shifted / fineness.shift)
    };
    let misses = (from + 1..to).map(|i| (i, miss(i)));
    let (worst, error) = misses.max_by(|a, b| a.1.total_cmp(&b.1))?;
    (error > 1.0).then_some(worst)
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_trace::replay;

    /// Tosses in the plane and in space, with drag and on a tilted table, that end on a face or roll on the
    /// side.
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
            (
                "engine.volumetric = {}\nsurface.table_tilt_deg = 8",
                "launch.preset = 'clean'",
            ),
        ];
        let mut traces = vec![];
        for (engine, launch) in scenes {
            let config = format!(
                "coin.ratio = 0.8\nsurface.restitution = 0.5\nsurface.friction = 0.3\n{launch}\n{engine}\n\
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
            let fine = Fineness::FINE;
            let keys = keyframes(&trace, fine);
            (all, kept) = (all + trace.records.len(), kept + keys.len());
            for pair in keys.windows(2) {
                assert_eq!(
                    worst(&trace.scene, &trace.records, pair[0], pair[1], fine),
                    None
                );
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

    /// A toss among hundreds keeps its first and its last record, and far fewer between.
    #[test]
    fn coarse_keyframes_are_few() {
        let traces = traces();
        let count = |fineness| -> usize {
            traces
                .iter()
                .map(|trace| keyframes(trace, fineness).len())
                .sum()
        };
        for trace in &traces {
            let keys = keyframes(trace, Fineness::COARSE);
            assert_eq!(
                (keys[0], *keys.last().unwrap()),
                (0, trace.records.len() - 1)
            );
        }
        let (coarse, fine) = (count(Fineness::COARSE), count(Fineness::FINE));
        assert!(3 * coarse < 2 * fine, "{coarse} of {fine}");
    }
}

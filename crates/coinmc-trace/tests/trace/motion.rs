//! The recorded motion is that of a coin.

use crate::plans::{all, event_driven, flat};
use coinmc_core::EventKind;
use coinmc_trace::{Mode, Record, RecordKind, Trace, default_rate_hz, replay};
use nalgebra::Vector3;

fn traces(tosses: u64, rate_hz: f64) -> impl Iterator<Item = Trace> {
    event_driven(tosses).into_iter().flat_map(move |plan| {
        (0..plan.points.len())
            .flat_map(|point| (0..tosses).map(move |toss| (point, toss)))
            .map(|(point, toss)| replay(&plan, point, toss, rate_hz).unwrap())
            .collect::<Vec<_>>()
    })
}

fn is_event(record: &Record, kind: EventKind) -> bool {
    record.kind == RecordKind::Event(kind)
}

/// Height of the lowest point of the cylinder with the quaternion's orientation.
fn lowest(trace: &Trace, record: &Record) -> f64 {
    let coin = &trace.scene.coin;
    let (half, radius) = (0.5 * coin.height_m(), coin.radius_m());
    let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()].map(|e| (record.orientation * e).z);
    record.state.position_m.z - half * z.abs() - radius * (x * x + y * y).sqrt()
}

#[test]
fn times_never_decrease_and_samples_are_at_the_requested_times() {
    for trace in traces(6, 730.0) {
        let times = trace.records.iter().map(|record| record.state.time_s);
        assert!(times.is_sorted());
        let samples = trace
            .records
            .iter()
            .filter(|r| r.kind == RecordKind::Sample);
        for (n, sample) in (1..).zip(samples) {
            let asked = f64::from(n) / 730.0;
            // engines use other units of time: an ulp or two
            assert!(
                (sample.state.time_s - asked).abs() <= 4e-16 * asked.max(1.0),
                "{asked}"
            );
        }
        // none is missing
        let last = trace.duration_s();
        let samples = trace
            .records
            .iter()
            .filter(|r| r.kind == RecordKind::Sample);
        assert!((samples.count() as f64 - (last * 730.0).floor()).abs() <= 1.0);
    }
}

#[test]
fn at_an_impact_the_rim_is_on_the_plane() {
    let mut impacts = 0;
    for trace in traces(10, 0.0) {
        for record in &trace.records {
            if is_event(record, EventKind::Touching) || is_event(record, EventKind::Impact) {
                assert!(
                    lowest(&trace, record).abs() < 1e-9,
                    "{}",
                    lowest(&trace, record)
                );
                impacts += 1;
            }
        }
    }
    assert!(impacts > 500, "{impacts}");
}

#[test]
fn the_coin_is_never_below_the_plane() {
    for trace in traces(6, 2000.0) {
        for record in &trace.records {
            // contact is kept to the integrator's tolerance
            assert!(lowest(&trace, record) > -1e-7, "{record:?}");
        }
    }
}

#[test]
fn the_quaternions_z_axis_is_u() {
    for trace in traces(4, 100.0) {
        for record in &trace.records {
            let off = record.orientation * Vector3::z() - record.state.axis.into_inner();
            assert!(
                off.norm() < 1e-13,
                "{} {}",
                off.norm(),
                record.state.axis.norm() - 1.0
            );
            assert!((record.orientation.coords.norm() - 1.0).abs() < 1e-13);
        }
    }
}

/// Without drag: samples of the first flight against the parabola, and the energy.
#[test]
fn samples_in_flight_follow_the_closed_form() {
    for trace in traces(5, 400.0).filter(|trace| trace.scene.drag().is_none()) {
        let first = trace.records[0].state;
        let flight = trace.records.iter();
        let g = Vector3::new(0.0, 0.0, -trace.scene.gravity_m_s2());
        for record in flight.take_while(|r| !is_event(r, EventKind::Impact)) {
            let t = record.state.time_s;
            let place = first.position_m + first.velocity_m_s * t + g * (0.5 * t * t);
            assert!((record.state.position_m - place).norm() < 1e-12);
            let lost = trace.records[0].energy_j_kg - record.energy_j_kg;
            assert!(
                lost.abs() < 1e-12 * trace.records[0].energy_j_kg.abs().max(1.0),
                "{lost}"
            );
        }
    }
}

#[test]
fn energy_never_grows() {
    for trace in traces(6, 1000.0) {
        let scene = &trace.scene;
        // the error of a step in contact is the engine's tolerance, 2e-4 of the energy of balance
        let slack = 1e-3 * scene.gravity_m_s2() * scene.coin.rim_distance_m();
        for pair in trace.records.windows(2) {
            assert!(
                pair[1].energy_j_kg <= pair[0].energy_j_kg + slack,
                "{pair:?}"
            );
        }
    }
}

/// In the plane the coin only turns about y: the quaternion has no other component.
#[test]
fn a_planar_toss_turns_only_about_y() {
    let plan = flat("moreau", 5);
    for toss in 0..5 {
        for record in &replay(&plan, 0, toss, 1000.0).unwrap().records {
            let q = record.orientation;
            assert!(q.i.abs() < 1e-9 && q.k.abs() < 1e-9, "{q}");
        }
    }
}

#[test]
fn modes_follow_events() {
    for plan in all(4) {
        for toss in 0..4 {
            let trace = replay(&plan, 0, toss, 300.0).unwrap();
            let mut mode = Mode::Flight;
            for record in &trace.records {
                match record.kind {
                    RecordKind::Event(EventKind::Sticking) => mode = Mode::Sticking,
                    RecordKind::Event(EventKind::Sliding) => mode = Mode::Sliding,
                    RecordKind::Event(EventKind::LiftOff) => mode = Mode::Flight,
                    RecordKind::Event(EventKind::Impact) => mode = record.mode,
                    RecordKind::Event(EventKind::Ended) => mode = Mode::Ended,
                    _ => {}
                }
                assert_eq!(record.mode, mode, "{record:?}");
            }
        }
    }
}

#[test]
fn the_default_rate_follows_the_coin_and_its_spin() {
    let plan = flat("moreau", 1);
    let (scene, mut launch) = (
        plan.points[0].scene,
        coinmc_trace::launch(&plan, 0, 0).unwrap(),
    );
    launch.spin_rad_s = Vector3::zeros();
    // 20/sqrt(D/g) with D = 1.02 cm is 620 per second
    assert_eq!(default_rate_hz(&scene, &launch), 1000.0);
    launch.spin_rad_s = Vector3::new(0.0, 500.0, 0.0);
    assert_eq!(default_rate_hz(&scene, &launch), 2000.0);
    launch.spin_rad_s.y = f64::INFINITY;
    assert!(default_rate_hz(&scene, &launch).is_finite());
}

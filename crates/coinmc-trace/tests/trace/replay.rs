//! A replayed toss is the toss of the run.

use crate::plans::{all, flat, space, table};
use coinmc::run::{Chunk, FinishedToss, TossSource, for_each_end, run_chunk, stream};
use coinmc_core::{EventKind, Tally};
use coinmc_trace::{RecordKind, outcome, replay, replay_within};

#[test]
fn replayed_outcomes_are_those_of_the_run_toss_by_toss() {
    for plan in all(12) {
        for point in 0..plan.points.len() {
            for toss in 0..12 {
                let chunk = Chunk {
                    point,
                    tosses: toss..toss + 1,
                };
                let run = run_chunk(&plan, &chunk).unwrap();
                let launch =
                    TossSource::Drawn(&stream(&plan, point)).launch(&plan.points[point], toss);
                for rate_hz in [0.0, 317.0] {
                    let trace = replay(&plan, point, toss, rate_hz).unwrap();
                    let mut tally = Tally::default();
                    tally.add_started(&trace.outcome, launch.up());
                    assert_eq!(tally, run, "{} {chunk}", trace.engine);
                }
            }
        }
    }
}

#[test]
fn observing_a_toss_does_not_change_it() {
    for plan in all(3) {
        for toss in 0..3 {
            let alone = outcome(&plan, 1, toss).unwrap();
            let events = replay(&plan, 1, toss, 0.0).unwrap();
            let watched = replay(&plan, 1, toss, 997.0).unwrap();
            assert_eq!(alone, events.outcome);
            assert_eq!(alone, watched.outcome);
            let kept = |record: &&coinmc_trace::Record| record.kind != RecordKind::Sample;
            let states = |trace: &coinmc_trace::Trace| {
                let kept = trace.records.iter().filter(kept);
                kept.map(|record| (record.kind, record.mode, record.state))
                    .collect::<Vec<_>>()
            };
            assert_eq!(states(&events), states(&watched), "{}", events.engine);
        }
    }
}

#[test]
fn a_trace_begins_with_the_launch_and_ends_with_the_end() {
    for plan in all(3) {
        for toss in 0..3 {
            let trace = replay(&plan, 0, toss, 500.0).unwrap();
            let [first, .., last] = &trace.records[..] else {
                panic!("a toss has a beginning and an end")
            };
            assert_eq!(first.kind, RecordKind::Event(EventKind::Launched));
            assert_eq!(last.kind, RecordKind::Event(EventKind::Ended));
            assert_eq!(first.state.time_s, 0.0);
            // engines convert the launch to other units
            let off = first.state.velocity_m_s - trace.launch.velocity_m_s;
            assert!(off.norm() < 1e-12, "{off}");
            let ends = |kind| trace.records.iter().filter(|r| r.kind == kind).count();
            assert_eq!(ends(RecordKind::Event(EventKind::Ended)), 1);
            let impacts = ends(RecordKind::Event(EventKind::Impact));
            assert_eq!(impacts, trace.outcome.impacts as usize, "{}", trace.engine);
        }
    }
}

#[test]
fn points_that_share_their_random_numbers_share_their_launches() {
    let paired = coinmc::config::parse(
        "test",
        &format!(
            "paired = true\n{}",
            flat("moreau", 5)
                .resolved_toml
                .replace("paired = false\n", "")
        ),
        &[],
    )
    .unwrap();
    let launch = |point| replay(&paired, point, 3, 0.0).unwrap().launch;
    assert_eq!(launch(0).spin_rad_s, launch(1).spin_rad_s);
    let apart = flat("moreau", 5);
    let launch = |point| replay(&apart, point, 3, 0.0).unwrap().launch;
    assert_ne!(launch(0).spin_rad_s, launch(1).spin_rad_s);
}

#[test]
fn memory_is_bounded_and_the_trace_reports_it() {
    let plan = space("moreau", 5);
    let whole = replay(&plan, 0, 2, 50_000.0).unwrap();
    assert_eq!(whole.samples_until_s, None);
    let cut = replay_within(&plan, 0, 2, 50_000.0, 1000).unwrap();
    assert!(cut.records.len() <= 1001 && cut.samples_until_s.is_some());
    assert_eq!(cut.outcome, whole.outcome);
    assert_eq!(
        cut.records.last(),
        whole
            .records
            .last()
            .map(|last| {
                // with fewer samples the rotation about the coin's own axis is less exact
                let mut last = *last;
                last.orientation = cut.records.last().unwrap().orientation;
                last
            })
            .as_ref()
    );
}

#[test]
fn a_trace_ends_like_the_toss_in_a_run() {
    for plan in [flat("moreau", 20), space("moreau", 20), table(20)] {
        let stream = coinmc::run::stream(&plan, 0);
        let mut compare = |toss: &FinishedToss| {
            for rate_hz in [0.0, 3000.0] {
                let trace = replay(&plan, 0, toss.toss, rate_hz).unwrap();
                assert_eq!(trace.outcome, toss.outcome);
                assert_eq!(trace.records.last().unwrap().state, toss.end);
            }
            true
        };
        let begin = TossSource::Drawn(&stream);
        assert!(for_each_end(&plan.points[0], begin, 0..20, &mut compare).unwrap());
    }
}

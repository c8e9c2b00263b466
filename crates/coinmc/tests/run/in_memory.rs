//! Counting in memory, reading back and individual tosses give the same counts as a run.

use crate::support::{
    Ear, FIXED, HALF_WIDTH, LONG, contents, plan, plan_in_space, plan_of, put_tallies, run_whole,
    run_with, tallies,
};
use coinmc::plan::Plan;
use coinmc::results::Results;
use coinmc::run::{
    Chunk, Count, Part, RunError, Status, TossSource, count, for_each_end, for_each_outcome,
    run_chunk, stored_report, stream, toss as toss_alone,
};
use coinmc_core::{Launch, Outcome, Tally};
use std::num::NonZeroUsize;
use tempfile::tempdir;

fn counted(plan: &Plan, threads: usize, ear: &Ear) -> (Results, Status, u64) {
    let options = Count {
        threads: NonZeroUsize::new(threads),
        cancel: &ear.cancel,
        sink: ear,
    };
    let report = count(plan, &options).unwrap();
    (report.results, report.status, report.tosses)
}

#[test]
fn counting_in_memory_equals_a_run() {
    for stop in [FIXED, HALF_WIDTH, "half_width = 0.001\nmax_tosses = 3000"] {
        let (plan, dir) = (plan(stop), tempdir().unwrap());
        let report = run_whole(&plan, dir.path());
        let run = (report.results, report.status, report.tosses);
        for threads in [1, 3] {
            assert_eq!(counted(&plan, threads, &Ear::default()), run, "{stop}");
        }
    }
}

#[test]
fn a_cancelled_count_reports_its_counts() {
    let plan = plan("tosses = 400_000");
    let ear = Ear::that_cancels_at(2);
    let (results, status, tosses) = counted(&plan, 2, &ear);
    assert_eq!(status, Status::Interrupted);
    assert!(tosses < 6 * 400_000, "{tosses}");
    let sum: u64 = results.rows.iter().map(|row| row.tally.tosses()).sum();
    assert_eq!(sum, tosses);
}

#[test]
fn a_directory_is_read_back_finished_or_not_and_not_touched() {
    let (plan, dir) = (plan(LONG), tempdir().unwrap());
    let ear = Ear::that_cancels_at(2);
    let cut = run_with(&plan, dir.path(), Part::WHOLE, 2, &ear).unwrap();
    let before = contents(dir.path());
    let (stored, report) = stored_report(dir.path(), &ear).unwrap();
    assert_eq!(contents(dir.path()), before);
    assert_eq!(stored, plan);
    assert_eq!(report.status, Status::Interrupted);
    assert_eq!(report.tosses, cut.tosses);
    // points without tosses have no probability, and what is not a number is not equal
    assert_eq!(report.results.to_json(), cut.results.to_json());

    let whole = run_whole(&plan, dir.path());
    let (_, report) = stored_report(dir.path(), &ear).unwrap();
    assert_eq!(report.status, Status::Complete);
    assert_eq!(report.results, whole.results);
    assert!(ear.warnings().is_empty());
}

#[test]
fn a_damaged_tally_is_reported_and_left_alone() {
    let (plan, dir) = (plan(FIXED), tempdir().unwrap());
    run_whole(&plan, dir.path());
    let mut texts = tallies(dir.path());
    texts[3] = "nonsense\n".to_owned();
    put_tallies(dir.path(), &texts);
    let before = contents(dir.path());
    let ear = Ear::default();
    let (_, report) = stored_report(dir.path(), &ear).unwrap();
    assert_eq!(report.status, Status::Interrupted);
    let [warning] = &ear.warnings()[..] else {
        panic!("{:?}", ear.warnings())
    };
    assert!(warning.contains("is rejected"), "{warning}");
    assert_eq!(contents(dir.path()), before);
}

#[test]
fn directories_without_a_run_are_rejected() {
    let dir = tempdir().unwrap();
    assert!(matches!(
        stored_report(dir.path(), &()),
        Err(RunError::NoRun { .. })
    ));
}

#[test]
fn individual_tosses_equal_those_of_a_chunk() {
    let plans = [plan(FIXED), plan_in_space("moreau", FIXED)];
    for plan in &plans {
        let (point, tosses) = (1, 30..330);
        let stream = stream(plan, point);
        let found = &plan.points[point];
        let source = TossSource::Drawn(&stream);
        let mut tally = Tally::default();
        let mut numbers = Vec::new();
        let mut add = |toss, outcome: &Outcome| {
            assert_eq!(
                *outcome,
                toss_alone(found, &source.launch(found, toss)).unwrap()
            );
            numbers.push(toss);
            tally.add_started(outcome, source.launch(found, toss).up());
            true
        };
        assert!(for_each_outcome(found, source, tosses.clone(), &mut add).unwrap());
        numbers.sort_unstable();
        assert!(numbers.into_iter().eq(tosses.clone()));
        let chunk = Chunk { point, tosses };
        assert!(tally.same > 0 && tally.same < tally.heads + tally.tails);
        assert_eq!(tally, run_chunk(plan, &chunk).unwrap());
    }
}

#[test]
fn a_given_launch_ends_like_the_same_drawn_launch() {
    let plans = [plan(FIXED), plan_in_space("moreau", FIXED)];
    for plan in &plans {
        let found = &plan.points[0];
        let stream = stream(plan, 0);
        let drawn = |toss| -> Launch { TossSource::Drawn(&stream).launch(found, toss) };
        let mut seen = Vec::new();
        for source in [TossSource::Drawn(&stream), TossSource::Given(&drawn)] {
            let mut keep = |toss: &_| {
                seen.push(*toss);
                true
            };
            assert!(for_each_end(found, source, 0..20, &mut keep).unwrap());
        }
        let (first, second) = seen.split_at(20);
        assert_eq!(first, second);
    }
}

#[test]
fn the_visitor_can_stop() {
    let plan = plan(FIXED);
    let stream = stream(&plan, 0);
    let mut seen = 0;
    let mut three = |_, _: &_| {
        seen += 1;
        seen < 3
    };
    for_each_outcome(
        &plan.points[0],
        TossSource::Drawn(&stream),
        0..1000,
        &mut three,
    )
    .unwrap();
    assert_eq!(seen, 3);
}

#[test]
fn a_closed_form_makes_no_tosses() {
    let text = "coin.ratio = 1\nengine.analytic.rule = 'arc'";
    let plan = coinmc::config::parse("test", text, &[]).unwrap();
    let stream = stream(&plan, 0);
    let source = TossSource::Drawn(&stream);
    let mut never = |_, _: &_| unreachable!("a closed form makes no toss");
    assert!(!for_each_outcome(&plan.points[0], source, 0..9, &mut never).unwrap());
    let fixed = plan_of("[coin]\nratio = 1.0\n[surface]\nrestitution = 0.5\n[stop]\ntosses = 9\n");
    assert_eq!(counted(&fixed, 1, &Ear::default()).2, 9);
}

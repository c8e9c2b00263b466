//! Points that stop at targets, alone and within a limit for the whole run.

use crate::support::{Ear, assert_same, contents, plan, run_whole, run_with};
use coinmc::plan::StoppedBy;
use coinmc::results::Row;
use coinmc::run::{Part, Status};
use coinmc_core::Estimate;
use std::time::{Duration, Instant};
use tempfile::tempdir;

/// The longest arm of any face's interval as a share of its probability.
fn relative_error(row: &Row) -> f64 {
    let of = |face: &Estimate| face.half_width() / face.p;
    of(&row.heads).max(of(&row.tails)).max(of(&row.side))
}

#[test]
fn every_point_has_as_many_tosses_as_its_target_needs() {
    let dir = tempdir().unwrap();
    let report = run_whole(&plan("half_width = 0.006"), dir.path());
    assert_eq!(report.status, Status::Complete);
    let mut all = 0;
    for row in &report.results.rows {
        assert_eq!(row.stopped_by, StoppedBy::Targets);
        assert!(
            row.half_width() <= 0.006 && row.half_width() > 0.0045,
            "{row:?}"
        );
        // 1.96² p (1 − p)/h² by who knew p
        let p = [row.heads.p, row.tails.p, row.side.p];
        let fixed = p.map(|p| 1.96 * 1.96 * p * (1.0 - p) / (0.006 * 0.006));
        let made = row.tally.tosses() + row.pilot_tosses;
        assert!(
            (made as f64) < 1.45 * fixed.into_iter().fold(0.0, f64::max),
            "{row:?}"
        );
        all += made;
    }
    assert_eq!(report.tosses, all);
}

/// The tosses of the run go to where the error is largest, so that all errors end about equal.
#[test]
fn a_limit_for_the_run_makes_all_errors_equal() {
    let (total, dir) = (600_000, tempdir().unwrap());
    let limited = plan(&format!("relative_error = 1e-3\ntotal_tosses = {total}"));
    let report = run_whole(&limited, dir.path());
    assert_eq!(report.status, Status::ShortOfTarget { points: 6 });
    assert!(
        report.tosses <= total && report.tosses > total - 6 * 256,
        "{}",
        report.tosses
    );
    let rows = &report.results.rows;
    let by = |row: &Row| row.stopped_by == StoppedBy::TotalTosses;
    assert!(rows.iter().all(by));
    let range = |values: Vec<f64>| {
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        values.into_iter().fold(0.0, f64::max) / least
    };
    let errors = rows.iter().map(relative_error).collect();
    let tosses = rows.iter().map(|row| row.tally.tosses() as f64).collect();
    let (errors, tosses) = (range(errors), range(tosses));
    assert!(errors < 1.15 && tosses > 1.5, "{errors} {tosses}");
}

#[test]
fn a_limit_for_the_run_that_is_not_reached_changes_nothing_but_the_config() {
    let dir = tempdir().unwrap();
    let free = run_whole(&plan("half_width = 0.006"), &dir.path().join("free"));
    let limited = plan("half_width = 0.006\ntotal_tosses = 10_000_000");
    let limited = run_whole(&limited, &dir.path().join("limited"));
    assert_eq!(free.results.rows, limited.results.rows);
}

/// Little for all: no pilot, equal shares, no more than is allowed.
#[test]
fn a_small_limit_for_the_run_is_shared_equally() {
    let dir = tempdir().unwrap();
    let report = run_whole(&plan("half_width = 0.001\ntotal_tosses = 6011"), dir.path());
    for row in &report.results.rows {
        assert_eq!((row.tally.tosses(), row.pilot_tosses), (1001, 0));
        assert_eq!(row.stopped_by, StoppedBy::TotalTosses);
    }
}

#[test]
fn threads_and_interruptions_change_nothing_within_a_limit_for_the_run() {
    for stop in [
        "half_width = 0.003\ntotal_tosses = 400_000",
        "relative_error = 0.05\ntotal_tosses = 60_000",
    ] {
        let (plan, dir) = (plan(stop), tempdir().unwrap());
        let whole = dir.path().join("whole");
        run_with(&plan, &whole, Part::WHOLE, 1, &Ear::default()).unwrap();
        for (threads, after) in [(3, 1), (2, 4), (1, 9)] {
            let broken = dir.path().join(format!("broken-{threads}"));
            let ear = Ear::that_cancels_at(after);
            run_with(&plan, &broken, Part::WHOLE, threads, &ear).unwrap();
            run_with(&plan, &broken, Part::WHOLE, threads, &Ear::default()).unwrap();
            assert_same(&whole, &broken);
        }
        assert!(!contents(&whole).is_empty());
    }
}

/// Computing time decides what is counted, so a run is repeated by its files: what a stopped run measured
/// still holds when it goes on.
#[test]
fn limits_of_time_hold_and_survive_interruptions() {
    for (stop, by) in [
        (
            "half_width = 1e-5\ntotal_core_seconds = 0.6",
            StoppedBy::TotalCoreSeconds,
        ),
        (
            "half_width = 1e-5\nmax_core_seconds = 0.1",
            StoppedBy::MaxCoreSeconds,
        ),
    ] {
        let (plan, dir) = (plan(stop), tempdir().unwrap());
        let broken = dir.path().join("broken");
        let begun = Instant::now();
        run_with(&plan, &broken, Part::WHOLE, 2, &Ear::that_cancels_at(20)).unwrap();
        let report = run_with(&plan, &broken, Part::WHOLE, 2, &Ear::default()).unwrap();
        // far more would be needed; a busy machine takes longer than its processors compute
        assert!(begun.elapsed() < Duration::from_secs(30));
        assert_eq!(report.status, Status::ShortOfTarget { points: 6 });
        let rows = &report.results.rows;
        for row in rows {
            assert_eq!(row.stopped_by, by);
            assert!(row.tally.tosses() >= 512);
        }
        // beyond the pilots; of one point, a busy machine may compute little in its time
        let pilots: u64 = rows.iter().map(|row| row.pilot_tosses).sum();
        let tosses: u64 = rows.iter().map(|row| row.tally.tosses()).sum();
        assert!(2 * pilots < tosses, "{pilots} of {tosses}");
        let before = contents(&broken);
        run_with(&plan, &broken, Part::WHOLE, 1, &Ear::default()).unwrap();
        assert_eq!(contents(&broken), before);
    }
}

#[test]
fn limits_of_time_that_are_not_reached_change_no_count() {
    let dir = tempdir().unwrap();
    let free = run_whole(&plan("half_width = 0.006"), &dir.path().join("free"));
    let timed = plan("half_width = 0.006\nmax_core_seconds = 1e6\ntotal_core_seconds = 1e6");
    let timed = run_whole(&timed, &dir.path().join("timed"));
    assert_eq!(free.results.rows, timed.results.rows);
}

//! Counts depend only on the plan: not on threads, interruptions or kills.

use crate::support::{
    Ear, FIXED, HALF_WIDTH, LONG, assert_same, contents, plan, plan_in_space, run_as_build,
    run_whole, run_with,
};
use coinmc::plan::StoppedBy;
use coinmc::results::Row;
use coinmc::run::{Chunk, Part, Status, run_chunk, stored_report};
use coinmc_core::{Face, Tally};
use std::process::{Command, Stdio};
use std::sync::atomic::Ordering::SeqCst;
use std::time::{Duration, Instant};
use tempfile::tempdir;

#[test]
fn threads_change_nothing() {
    for stop in [FIXED, HALF_WIDTH] {
        let (plan, dir) = (plan(stop), tempdir().unwrap());
        for threads in [1, 2, 4] {
            let out = dir.path().join(threads.to_string());
            let report = run_with(&plan, &out, Part::WHOLE, threads, &Ear::default()).unwrap();
            assert_eq!(report.status, Status::Complete);
            assert_same(&dir.path().join("1"), &out);
        }
    }
}

#[test]
fn a_run_equals_the_sum_of_its_chunks() {
    let (plan, dir) = (plan(FIXED), tempdir().unwrap());
    let report = run_whole(&plan, dir.path());
    for (point, row) in report.results.rows.iter().enumerate() {
        let mut sum = Tally::default();
        for tosses in [0..1, 1..77, 77..16_384, 16_384..16_384, 16_384..40_000] {
            sum.merge(&run_chunk(&plan, &Chunk { point, tosses }).unwrap());
        }
        assert_eq!(sum, row.tally);
        assert_eq!(*row, Row::new(&plan, point, sum, StoppedBy::Tosses));
    }
}

#[test]
fn interruptions_change_nothing() {
    for stop in [LONG, HALF_WIDTH] {
        let (plan, dir) = (plan(stop), tempdir().unwrap());
        let (whole, broken) = (dir.path().join("whole"), dir.path().join("broken"));
        run_whole(&plan, &whole);
        let mut breaks = 0;
        loop {
            let ear = Ear::that_cancels_at(1 + breaks % 3);
            let report = run_with(&plan, &broken, Part::WHOLE, 2, &ear).unwrap();
            assert!(ear.warnings().is_empty(), "{:?}", ear.warnings());
            if report.status == Status::Complete {
                break;
            }
            assert_eq!(report.status, Status::Interrupted);
            let files = contents(&broken);
            assert!(files.contains_key("results.partial.csv"));
            assert!(!files.contains_key("results.csv") && !files.contains_key("results.parquet"));
            breaks += 1;
            assert!(breaks < 100, "each run should finish a chunk at least");
        }
        assert!(breaks >= 2, "{breaks}");
        assert_same(&whole, &broken);
    }
}

/// A chunk of a second and more is kept as far as it is counted, and goes on from there.
#[test]
fn a_chunk_goes_on_where_it_was_stopped() {
    let text = "seed = 3\ncoin.ratio = 0.2\nsurface.material = 'wood'\nlaunch.preset = 'hand'\n\
                engine.volumetric = {}\nstop.tosses = 8192";
    let plan = coinmc::config::parse("test", text, &[]).unwrap();
    let dir = tempdir().unwrap();
    let (whole, broken) = (dir.path().join("whole"), dir.path().join("broken"));
    run_with(&plan, &whole, Part::WHOLE, 1, &Ear::default()).unwrap();
    assert!(!contents(&whole).contains_key("unfinished.txt"));
    let ear = Ear::that_cancels_at(1);
    let report = run_with(&plan, &broken, Part::WHOLE, 1, &ear).unwrap();
    assert_eq!(report.status, Status::Interrupted);
    let kept = report.tosses;
    assert!(0 < kept && kept < 8192, "{kept}");
    assert_eq!(report.results.rows[0].tally.tosses(), kept);
    let (_, stored) = stored_report(&broken, &Ear::default()).unwrap();
    assert_eq!(stored.tosses, kept);
    let ear = Ear::default();
    let report = run_with(&plan, &broken, Part::WHOLE, 1, &ear).unwrap();
    assert_eq!(report.status, Status::Complete);
    let last = ear.progress.lock().unwrap().last().copied();
    assert_eq!(last.unwrap().tosses_reused, kept);
    assert_same(&whole, &broken);
}

#[test]
fn a_beginning_that_is_damaged_is_counted_anew() {
    let (plan, dir) = (plan(FIXED), tempdir().unwrap());
    let (whole, broken) = (dir.path().join("whole"), dir.path().join("broken"));
    run_whole(&plan, &whole);
    run_with(&plan, &broken, Part::WHOLE, 1, &Ear::that_cancels_at(1)).unwrap();
    let tallies = std::fs::read_to_string(whole.join("tallies.txt")).unwrap();
    // of another length, and not sealed
    let forged = tallies.replace("tosses 0 16384", "tosses 0 9999");
    for text in [
        forged.as_str(),
        "coinmc tally 2\n",
        "",
        "\u{0}\u{ff}",
        &tallies,
    ] {
        std::fs::write(broken.join("unfinished.txt"), text).unwrap();
        let ear = Ear::that_cancels_at(1);
        run_with(&plan, &broken, Part::WHOLE, 1, &ear).unwrap();
    }
    run_whole(&plan, &broken);
    assert_same(&whole, &broken);
}

/// A kill after a chunk is stored, and before its beginning is forgotten.
#[test]
fn a_finished_part_has_no_beginnings() {
    let (plan, dir) = (plan(FIXED), tempdir().unwrap());
    let part = Part::new(1, 2).unwrap();
    run_with(&plan, dir.path(), part, 1, &Ear::default()).unwrap();
    let beginnings = dir.path().join("unfinished.txt");
    std::fs::copy(dir.path().join("tallies.txt"), &beginnings).unwrap();
    run_with(&plan, dir.path(), part, 1, &Ear::default()).unwrap();
    assert!(!beginnings.exists());
}

#[test]
fn a_finished_run_is_only_reported() {
    let (plan, dir) = (plan(FIXED), tempdir().unwrap());
    let first = run_whole(&plan, dir.path());
    let before = contents(dir.path());
    let ear = Ear::default();
    let again = run_with(&plan, dir.path(), Part::WHOLE, 2, &ear).unwrap();
    assert_eq!(again.reused_chunks, 18);
    assert_eq!(first.results, again.results);
    assert_eq!(before, contents(dir.path()));
    let heard = ear.progress.lock().unwrap();
    let last = heard.last().unwrap();
    assert_eq!(last.tosses_reused, 240_000);
}

#[test]
fn edited_results_are_restored_with_a_warning() {
    let (plan, dir) = (plan(FIXED), tempdir().unwrap());
    run_whole(&plan, dir.path());
    let before = contents(dir.path());
    std::fs::write(dir.path().join("results.csv"), "mine").unwrap();
    std::fs::remove_file(dir.path().join("results.parquet")).unwrap();
    let ear = Ear::default();
    run_with(&plan, dir.path(), Part::WHOLE, 2, &ear).unwrap();
    assert_eq!(before, contents(dir.path()));
    let warnings = ear.warnings();
    assert!(
        warnings.len() == 1 && warnings[0].contains("results.csv"),
        "{warnings:?}"
    );
}

#[test]
fn progress_only_goes_forward_and_ends_where_it_was_planned() {
    for stop in [FIXED, HALF_WIDTH] {
        let (plan, dir, ear) = (plan(stop), tempdir().unwrap(), Ear::default());
        let report = run_with(&plan, dir.path(), Part::WHOLE, 2, &ear).unwrap();
        let heard = ear.progress.lock().unwrap();
        assert!(
            heard
                .windows(2)
                .all(|w| w[0].tosses_done <= w[1].tosses_done)
        );
        assert!(
            heard
                .windows(2)
                .all(|w| w[0].points_done <= w[1].points_done)
        );
        let last = heard.last().unwrap();
        assert_eq!((heard[0].tosses_done, heard[0].worst_half_width), (0, None));
        // and what a point shows is told all along
        assert_eq!(heard[0].latest, None);
        assert!(heard[1..].iter().all(|told| told.latest.is_some()));
        assert_eq!((last.points_done, last.points), (6, 6));
        assert_eq!(
            (last.tosses_done, last.tosses_planned),
            (report.tosses, report.tosses)
        );
        // Wilson's arms are within 1 % of Clopper and Pearson's at this many tosses
        let worst = report
            .results
            .rows
            .iter()
            .map(Row::half_width)
            .fold(0.0, f64::max);
        assert!((last.worst_half_width.unwrap() / worst - 1.0).abs() < 0.01);
        let told = last.latest.unwrap();
        let row = report.results.rows.at(told.point);
        assert_eq!((told.face, told.estimate.p), (Face::Side, row.side.p));
        assert!((told.estimate.half_width() / row.side.half_width() - 1.0).abs() < 0.05);
    }
}

/// What is stored of points that stop at targets is more than the pilots that are planned at first.
#[test]
fn a_resumed_run_is_never_more_than_finished() {
    let (plan, dir) = (plan(HALF_WIDTH), tempdir().expect("a directory"));
    let report = run_whole(&plan, dir.path());
    let ear = Ear::default();
    run_with(&plan, dir.path(), Part::WHOLE, 1, &ear).expect("a finished run");
    let heard = ear.progress.lock().expect("an ear that did not panic");
    assert_eq!(heard[0].tosses_done, report.tosses);
    for told in heard.iter() {
        assert!(told.tosses_done <= told.tosses_planned, "{told:?}");
    }
}

/// The engine in space, by each of its laws: cut, shared out and broken off, it counts the same.
#[test]
fn tosses_in_space_depend_on_the_plan_alone() {
    for law in ["moreau", "chatterjee-ruina", "stronge"] {
        // two chunks a point
        let (plan, dir) = (plan_in_space(law, "tosses = 17_000"), tempdir().unwrap());
        let (whole, broken) = (dir.path().join("whole"), dir.path().join("broken"));
        let report = run_with(&plan, &whole, Part::WHOLE, 1, &Ear::default()).unwrap();
        let row = &report.results.rows[1];
        assert_eq!((row.engine, row.law), ("volumetric", law));
        let mut sum = Tally::default();
        for tosses in [0..1, 1..16_385, 16_385..17_000] {
            sum.merge(&run_chunk(&plan, &Chunk { point: 1, tosses }).unwrap());
        }
        assert_eq!((sum, sum.tosses()), (row.tally, 17_000));
        let mut breaks = 0;
        while {
            // the first time before the first toss
            let ear = Ear::that_cancels_at(breaks % 3);
            let report = run_with(&plan, &broken, Part::WHOLE, 2, &ear).unwrap();
            report.status != Status::Complete
        } {
            breaks += 1;
            assert!(breaks < 100, "each run should finish a chunk at least");
        }
        assert!(breaks >= 1);
        assert_same(&whole, &broken);
    }
}

/// A chunk of this run would take minutes, and a list of them more memory than there is.
#[test]
fn the_longest_run_starts_at_once_and_stops_on_request() {
    let (plan, dir, ear) = (
        plan("tosses = 1_000_000_000_000"),
        tempdir().unwrap(),
        Ear::default(),
    );
    let begun = Instant::now();
    let report = std::thread::scope(|scope| {
        scope.spawn(|| {
            std::thread::sleep(Duration::from_millis(100));
            ear.cancel.store(true, SeqCst);
        });
        run_with(&plan, dir.path(), Part::WHOLE, 2, &ear).unwrap()
    });
    assert_eq!(report.status, Status::Interrupted);
    // 0.1 s to wait, 0.1 ms to stop: the rest is for a busy machine
    assert!(
        begun.elapsed() < Duration::from_secs(3),
        "{:?}",
        begun.elapsed()
    );
}

/// Name of the environment variable that tells the child where to run.
const CHILD: &str = "COINMC_TEST_RUN_DIRECTORY";

/// Not a test of its own: what the next test starts and kills.
#[test]
fn child_that_is_killed() {
    if let Some(out) = std::env::var_os(CHILD) {
        run_whole(&plan(HALF_WIDTH), out.as_ref());
    }
}

#[test]
fn kills_at_any_instant_change_nothing() {
    let (plan, dir) = (plan(HALF_WIDTH), tempdir().unwrap());
    let (whole, killed) = (dir.path().join("whole"), dir.path().join("killed"));
    run_whole(&plan, &whole);
    // From before the directory exists to after the results are written.
    for round in 0..3 {
        for millis in [1, 3, 5, 8, 13, 21, 34, 55, 89, 144] {
            let mut child = Command::new(std::env::current_exe().unwrap())
                .args(["resume::child_that_is_killed", "--exact"])
                .env(CHILD, &killed)
                .stdout(Stdio::null())
                .spawn()
                .unwrap();
            std::thread::sleep(Duration::from_micros(1000 * millis + 300 * round));
            // it may have finished
            let _ = child.kill();
            child.wait().unwrap();
        }
        let ear = Ear::default();
        run_with(&plan, &killed, Part::WHOLE, 2, &ear).unwrap();
        assert!(ear.warnings().is_empty(), "{:?}", ear.warnings());
        assert_same(&whole, &killed);
        std::fs::remove_dir_all(&killed).unwrap();
    }
}

#[test]
fn another_build_resumes_a_run_with_a_warning() {
    let (plan, dir) = (plan(LONG), tempdir().unwrap());
    let (whole, mixed) = (dir.path().join("whole"), dir.path().join("mixed"));
    run_whole(&plan, &whole);
    let run_by = |build: &str, ear: &Ear| {
        let report = run_as_build(build, &plan, &mixed, Part::WHOLE, 2, ear).unwrap();
        (report.status, ear.warnings())
    };
    let (old, new) = ("0.1.0 (1111111 2026-01-01)", "0.1.0 (2222222 2026-01-02)");
    let begun = run_by(old, &Ear::that_cancels_at(2));
    assert_eq!(begun, (Status::Interrupted, vec![]));

    let (status, warnings) = run_by(new, &Ear::default());
    assert_eq!(status, Status::Complete);
    let [warning] = &warnings[..] else {
        panic!("{warnings:?}")
    };
    assert!(warning.contains(old) && warning.contains(new), "{warning}");

    let (mut whole, mut mixed_files) = (contents(&whole), contents(&mixed));
    whole.remove("manifest.json");
    let manifest = mixed_files.remove("manifest.json").unwrap();
    let manifest = String::from_utf8(manifest).unwrap();
    assert!(
        manifest.contains(old) && manifest.contains(new),
        "{manifest}"
    );
    assert_eq!(whole, mixed_files, "only the manifest names builds");

    // both have worked on it by now
    assert_eq!(run_by(old, &Ear::default()), (Status::Complete, vec![]));
}

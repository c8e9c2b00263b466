//! A run that asks for more goes on from what is there, and ends in the bytes of one that asked for it at once.

use crate::support::{Ear, assert_same, contents, plan, plan_of, run_whole, run_with};
use coinmc::plan::Plan;
use coinmc::run::stored_report;
use coinmc::run::{
    Delivery, Part, Report, RunError, Session, Status, Step, chunk_text, provenance,
};
use std::fs;
use std::num::NonZeroUsize;
use std::path::Path;
use tempfile::tempdir;

/// A plan of tosses that take little time.
fn quick(tosses: u64) -> Plan {
    let text = format!(
        "coin.ratio = 1\nsurface.landing = 'adhesive'\nlaunch.preset = 'clean'\nengine.volumetric = {{}}\n\
         sampling.method = 'random'\nstop.tosses = {tosses}"
    );
    coinmc::config::parse("test", &text, &[]).unwrap_or_else(|problems| panic!("{problems}"))
}

/// Goes on with a plan; returns how many tosses were taken over, too.
fn go_on(plan: &Plan, out: &Path) -> (Report, u64) {
    let ear = Ear::default();
    let report = run_with(plan, out, Part::WHOLE, 2, &ear).unwrap();
    assert_eq!(ear.warnings(), Vec::<String>::new());
    let last = *ear.progress.lock().unwrap().last().unwrap();
    (report, last.tosses_reused)
}

/// Runs `old`, goes on with `new`, and compares with a run of `new` alone; returns the tosses taken over.
fn same_as_at_once(old: &Plan, new: &Plan) -> u64 {
    let dir = tempdir().unwrap();
    let (one, at_once) = (dir.path().join("one"), dir.path().join("at_once"));
    run_whole(old, &one);
    run_whole(new, &at_once);
    let (_, reused) = go_on(new, &one);
    assert_same(&one, &at_once);
    reused
}

#[test]
fn more_tosses_go_on_and_end_in_the_same_bytes() {
    let [less, more] = ["tosses = 20_000", "tosses = 70_000"].map(plan);
    assert_eq!(same_as_at_once(&less, &more), 6 * 20_000);
    // from chunks of 2^14 tosses, the last of them short, to chunks of 2^15
    let [less, more] = [200_000, 5_000_000].map(quick);
    assert_eq!(same_as_at_once(&less, &more), 200_000);
}

#[test]
fn a_tighter_target_goes_on_and_ends_in_the_same_bytes() {
    let [loose, tight] = ["half_width = 0.006", "half_width = 0.003"].map(plan);
    let dir = tempdir().unwrap();
    let made = run_whole(&loose, dir.path()).tosses;
    let reused = same_as_at_once(&loose, &tight);
    // all but what was tossed for chunks that are cut elsewhere
    assert!(reused > made / 2 && reused <= made, "{reused} of {made}");
}

/// One plan with more and more values.
fn ratios(list: &str, rest: &str) -> Plan {
    plan_of(&format!(
        "[coin]\nratio = {list}\n[surface]\nrestitution = [0.3, 0.6]\n[stop]\ntosses = 20_000\n{rest}"
    ))
}

#[test]
fn more_values_of_the_first_axis_toss_the_new_points_only() {
    let (few, more) = (ratios("[1.0, 2.0]", ""), ratios("[1.0, 2.0, 1.5]", ""));
    assert_eq!(same_as_at_once(&few, &more), 4 * 20_000);
}

#[test]
fn points_with_other_random_numbers_are_not_reused() {
    let dir = tempdir().unwrap();
    run_whole(&ratios("[1.0, 2.0]", ""), dir.path());
    let before = contents(dir.path());
    let error = run_with(
        &ratios("[1.0, 1.5, 2.0]", ""),
        dir.path(),
        Part::WHOLE,
        2,
        &Ear::default(),
    );
    let text = error.unwrap_err().to_string();
    assert!(
        text.contains("coin.ratio [1.0, 2.0] -> { from = 1.0"),
        "{text}"
    );
    assert!(text.contains("put new values at the end"), "{text}");
    assert_eq!(contents(dir.path()), before);
}

/// Where points share their random numbers, each is the same toss by toss wherever it stands.
#[test]
fn paired_points_go_on_wherever_they_stand() {
    let paired = |list| {
        let text = ratios(list, "")
            .resolved_toml
            .replace("paired = false", "paired = true");
        coinmc::config::parse("test", &text, &[]).unwrap()
    };
    let (few, more) = (paired("[1.0, 2.0]"), paired("[0.5, 1.0, 1.5, 2.0]"));
    assert_eq!(same_as_at_once(&few, &more), 4 * 20_000);
}

#[test]
fn another_plan_is_refused_with_the_keys_that_changed() {
    let dir = tempdir().unwrap();
    run_whole(&plan("tosses = 1000"), dir.path());
    let before = contents(dir.path());
    for (stop, word) in [
        ("tosses = 999", "stop.tosses 1000 -> 999"),
        ("half_width = 0.01", "stop.tosses 1000 -> none"),
    ] {
        let refused = run_with(&plan(stop), dir.path(), Part::WHOLE, 2, &Ear::default());
        let error = refused.unwrap_err();
        assert!(matches!(error, RunError::OtherPlan { .. }));
        assert!(error.to_string().contains(word), "{error}");
    }
    assert_eq!(contents(dir.path()), before);
}

/// Other parts may have gone on already, or not yet.
#[test]
fn a_part_does_not_go_on_with_another_plan() {
    let part = |index| Part::new(index, 2).unwrap();
    for (before, now) in [
        (part(1), part(1)),
        (part(1), Part::WHOLE),
        (Part::WHOLE, part(2)),
    ] {
        let dir = tempdir().unwrap();
        let quiet = Ear::default();
        run_with(&plan("tosses = 1000"), dir.path(), before, 2, &quiet).unwrap();
        let kept = contents(dir.path());
        let refused = run_with(&plan("tosses = 2000"), dir.path(), now, 2, &quiet).unwrap_err();
        assert!(refused.to_string().contains("a part of a run"), "{refused}");
        assert_eq!(contents(dir.path()), kept);
    }
}

/// Stopped at any moment the directory holds the counts and the table of the earlier run, and goes on.
#[test]
fn an_extended_run_that_is_stopped_has_the_old_result() {
    let dir = tempdir().unwrap();
    let (one, at_once) = (dir.path().join("one"), dir.path().join("at_once"));
    let [less, more] = ["tosses = 40_000", "tosses = 190_000"].map(plan);
    run_whole(&less, &one);
    let table = fs::read(one.join("results.csv")).unwrap();
    for cancel_at in [0, 1, 3] {
        let ear = Ear::that_cancels_at(cancel_at);
        let report = run_with(&more, &one, Part::WHOLE, 2, &ear).unwrap();
        assert_eq!(report.status, Status::Interrupted);
        assert!(
            report
                .results
                .rows
                .iter()
                .all(|row| row.tally.tosses() >= 40_000)
        );
        assert_eq!(fs::read(one.join("results.before.csv")).unwrap(), table);
        let (_, stored) = stored_report(&one, &Ear::default()).unwrap();
        assert!(
            stored
                .results
                .rows
                .iter()
                .all(|row| row.tally.tosses() >= 40_000)
        );
    }
    // even more, from the middle
    let most = plan("tosses = 200_000");
    let (_, reused) = go_on(&most, &one);
    assert!(reused >= 6 * 40_000);
    run_whole(&most, &at_once);
    assert_same(&one, &at_once);
}

/// A run that itself extends another, not finished, is extended; the disk is full, or the kill comes, where the
/// manifest would name the new plan. Whichever plan goes on, no toss is lost.
#[test]
fn a_change_of_an_unfinished_extension_that_is_cut_short_loses_nothing() {
    let dir = tempdir().unwrap();
    let [a, b, c] = ["tosses = 40_000", "tosses = 90_000", "tosses = 100_000"].map(plan);
    let (run, at_once) = (dir.path().join("run"), dir.path().join("at_once"));
    run_whole(&c, &at_once);
    run_whole(&a, &run);
    run_with(&b, &run, Part::WHOLE, 2, &Ear::that_cancels_at(0)).unwrap();
    let manifest = fs::read(run.join("manifest.json")).unwrap();
    fs::create_dir(run.join("manifest.json.tmp")).unwrap();
    run_with(&c, &run, Part::WHOLE, 2, &Ear::default()).unwrap_err();
    fs::remove_dir(run.join("manifest.json.tmp")).unwrap();
    assert_eq!(fs::read(run.join("manifest.json")).unwrap(), manifest);
    let (_, stored) = stored_report(&run, &Ear::default()).unwrap();
    let tosses = |row: &coinmc::results::Row| row.tally.tosses();
    assert!(stored.results.rows.iter().map(tosses).all(|n| n >= 40_000));
    let (_, reused) = go_on(&c, &run);
    assert!(reused >= 240_000, "{reused}");
    assert_same(&run, &at_once);
}

/// A kill between any two steps of the change.
#[test]
fn a_change_that_is_cut_short_loses_nothing() {
    let dir = tempdir().unwrap();
    let [less, more] = ["tosses = 40_000", "tosses = 90_000"].map(plan);
    let at_once = dir.path().join("at_once");
    run_whole(&more, &at_once);
    let (old, new) = (dir.path().join("old"), dir.path().join("new"));
    run_whole(&less, &old);
    run_whole(&less, &new);
    run_with(&more, &new, Part::WHOLE, 2, &Ear::that_cancels_at(0)).unwrap();
    let copy = |from: &Path, names: &[&str], to: &Path| {
        for name in names {
            fs::copy(from.join(name), to.join(name)).unwrap();
        }
    };
    // before the manifest: still the old run, and again the old one
    let begun = dir.path().join("begun");
    fs::create_dir(&begun).unwrap();
    let files = [
        "manifest.json",
        "config.toml",
        "tallies.txt",
        "results.csv",
        "results.parquet",
    ];
    copy(&old, &files, &begun);
    fs::copy(new.join("earlier.txt"), begun.join("earlier.next.txt")).unwrap();
    let (report, reused) = go_on(&less, &begun);
    assert_eq!((report.tosses, reused), (240_000, 240_000));
    assert!(!begun.join("earlier.next.txt").exists());
    // after it
    copy(&new, &["manifest.json"], &begun);
    fs::copy(new.join("earlier.txt"), begun.join("earlier.next.txt")).unwrap();
    let (_, reused) = go_on(&more, &begun);
    assert_eq!(reused, 240_000);
    assert_same(&begun, &at_once);
}

#[test]
fn executors_go_on_too() {
    let dir = tempdir().unwrap();
    let (one, at_once) = (dir.path().join("one"), dir.path().join("at_once"));
    let [less, more] = ["tosses = 40_000", "tosses = 60_000"].map(plan);
    run_whole(&less, &one);
    run_whole(&more, &at_once);
    let mut session = Session::open(&more, &one, "0.1.0 (test)", &()).unwrap();
    let mut tossed = 0;
    while let Step::Chunk(chunk) = session.next() {
        tossed += chunk.tosses.end - chunk.tosses.start;
        let text = chunk_text(&more, &chunk, NonZeroUsize::MIN, || true)
            .unwrap()
            .unwrap();
        session.accept([Delivery::from(text.as_bytes())]).unwrap();
    }
    session.conclude(&()).unwrap();
    assert_eq!(tossed, 6 * (60_000 - 2 * 16_384));
    assert_same(&one, &at_once);
}

#[test]
fn who_made_the_earlier_tosses_stays_on_record() {
    let dir = tempdir().unwrap();
    let [less, more] = [200_000, 5_000_000].map(quick);
    run_whole(&less, dir.path());
    go_on(&more, dir.path());
    let made = provenance(dir.path(), &more).unwrap();
    assert_eq!(made.unrecorded_chunks, 0);
    let tosses: u64 = made.contributions.iter().map(|one| one.tosses).sum();
    assert_eq!(tosses, 5_000_000);
}

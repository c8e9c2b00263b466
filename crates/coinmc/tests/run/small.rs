//! Runs of a few hundred tosses: what they hold is what they would hold of millions.

use crate::support::{
    Ear, assert_same, contents, plan, plan_of, run_as_build, run_whole, run_with, tallies,
};
use coinmc::plan::Plan;
use coinmc::run::{
    Chunk, Delivery, Part, RunError, Session, Status, Step, chunk_text, chunk_with_note,
    is_running, merge, missing, provenance, run_chunk, stored_chunks, stored_plan, stored_report,
    text_of_tally,
};
use coinmc_core::Tally;
use std::fs;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use tempfile::tempdir;

/// Six points, and a chunk for each.
const SMALL: &str = "tosses = 100";

/// Two parts in directories of their own, by two builds.
fn two_parts(plan: &Plan, dir: &Path) -> [PathBuf; 2] {
    [(1, "0.1.0 (one)"), (2, "0.1.0 (two)")].map(|(index, build)| {
        let (out, part) = (
            dir.join(format!("part{index}")),
            Part::new(index, 2).unwrap(),
        );
        let report = run_as_build(build, plan, &out, part, 1, &Ear::default()).unwrap();
        assert_eq!((report.status, report.tosses), (Status::Part, 300));
        let table = fs::read_to_string(out.join("results.partial.csv")).unwrap();
        assert_eq!(table.lines().count(), 1 + 6);
        out
    })
}

#[test]
fn merged_parts_equal_the_whole_and_tell_who_made_them() {
    let (plan, dir) = (plan(SMALL), tempdir().unwrap());
    let parts = two_parts(&plan, dir.path());
    let [whole, merged] = ["whole", "merged"].map(|name| dir.path().join(name));
    run_whole(&plan, &whole);
    merge(&parts, &merged, &()).unwrap();
    // overlapping parts that agree are no harm
    let overlapping = [&parts[..], std::slice::from_ref(&whole)].concat();
    merge(&overlapping, &dir.path().join("overlapping"), &()).unwrap();
    let (mut of_whole, mut of_merged) = (contents(&whole), contents(&merged));
    assert!(of_whole.remove("manifest.json") != of_merged.remove("manifest.json"));
    assert_eq!(of_whole, of_merged, "only the manifest names builds");
    let made = provenance(&merged, &plan).unwrap();
    let by = made.contributions.iter();
    let by: Vec<_> = by
        .map(|one| (one.maker.build.as_str(), one.chunks))
        .collect();
    assert_eq!(by, [("0.1.0 (one)", 3), ("0.1.0 (two)", 3)]);
    assert_eq!(made.unrecorded_chunks, 0);
}

#[test]
fn a_part_that_is_missing_is_named() {
    let (plan, dir) = (plan(SMALL), tempdir().unwrap());
    let parts = two_parts(&plan, dir.path());
    let lacking = missing(&parts[1..], &()).unwrap().unwrap();
    assert_eq!((lacking.total, lacking.names()), (3, "1/2".to_owned()));
    assert_eq!(missing(&parts, &()).unwrap(), None);
}

/// The merged run may hold chunks already, which must be the same.
#[test]
fn a_part_that_disagrees_with_the_merged_run_is_refused() {
    let (plan, dir) = (plan(SMALL), tempdir().unwrap());
    let [part, merged] = ["part", "merged"].map(|name| dir.path().join(name));
    run_whole(&plan, &part);
    run_whole(&plan, &merged);
    let before = contents(&merged);
    merge(std::slice::from_ref(&part), &merged, &()).unwrap();
    assert_eq!(contents(&merged), before);

    let (point, tosses) = (2, 0..100);
    let heads = Tally {
        heads: 100,
        ..Tally::default()
    };
    let mut texts = tallies(&part);
    texts[point] = text_of_tally(&plan, &Chunk { point, tosses }, &heads);
    fs::write(part.join("tallies.txt"), texts.concat()).unwrap();
    let error = merge(std::slice::from_ref(&part), &merged, &()).unwrap_err();
    let RunError::Conflict {
        chunk,
        first,
        second,
    } = error
    else {
        panic!("{error}")
    };
    assert_eq!((chunk.point, first, second), (point, part, merged.clone()));
    assert_eq!(contents(&merged), before);
}

#[test]
fn more_tosses_go_on_from_those_that_are_there() {
    let (dir, ear) = (tempdir().unwrap(), Ear::default());
    let [one, at_once] = ["one", "at_once"].map(|name| dir.path().join(name));
    let more = plan("tosses = 150");
    run_whole(&plan(SMALL), &one);
    let report = run_with(&more, &one, Part::WHOLE, 1, &ear).unwrap();
    assert_eq!((report.tosses, ear.warnings()), (900, vec![]));
    let last = *ear.progress.lock().unwrap().last().unwrap();
    assert_eq!((last.tosses_done, last.tosses_reused), (900, 600));
    run_whole(&more, &at_once);
    assert_same(&one, &at_once);
}

#[test]
fn the_text_of_a_chunk_is_what_a_run_stores_of_it() {
    let (plan, dir) = (plan(SMALL), tempdir().unwrap());
    run_whole(&plan, dir.path());
    for (point, stored) in tallies(dir.path()).iter().enumerate() {
        let chunk = Chunk {
            point,
            tosses: 0..100,
        };
        let text = chunk_text(&plan, &chunk, NonZeroUsize::MIN, || true).unwrap();
        assert_eq!(text.as_ref(), Some(stored));
        let tally = run_chunk(&plan, &chunk).unwrap();
        assert_eq!(text_of_tally(&plan, &chunk, &tally), *stored);
        let stopped = chunk_text(&plan, &chunk, NonZeroUsize::MIN, || false).unwrap();
        assert_eq!(stopped, None);
    }
}

#[test]
fn a_run_that_another_build_goes_on_with_names_both() {
    let (plan, dir) = (plan(SMALL), tempdir().unwrap());
    let warnings = |build| {
        let ear = Ear::default();
        run_as_build(build, &plan, dir.path(), Part::WHOLE, 1, &ear).unwrap();
        ear.warnings()
    };
    assert_eq!(warnings("0.1.0 (one)"), Vec::<String>::new());
    let [warning] = &warnings("0.1.0 (two)")[..] else {
        panic!("a warning")
    };
    assert!(
        warning.contains("begun by coinmc 0.1.0 (one) and is resumed by coinmc 0.1.0 (two),"),
        "{warning}"
    );
    let [warning] = &warnings("0.1.0 (three)")[..] else {
        panic!("a warning")
    };
    assert!(
        warning.contains("0.1.0 (one), 0.1.0 (two) and"),
        "{warning}"
    );
    assert_eq!(warnings("0.1.0 (one)"), Vec::<String>::new());
}

#[test]
fn a_part_is_told_what_differs_from_the_plan_that_it_does_not_go_on_with() {
    let (dir, half) = (tempdir().unwrap(), Part::new(1, 2).unwrap());
    let quiet = Ear::default();
    run_with(&plan(SMALL), dir.path(), half, 1, &quiet).unwrap();
    let refused = run_with(&plan("tosses = 150"), dir.path(), half, 1, &quiet).unwrap_err();
    let text = refused.to_string();
    assert!(
        text.contains("stop.tosses 100 -> 150, and a part of a run cannot go on"),
        "{text}"
    );
}

/// A run that is finished writes nothing: every file is the same, and not a copy of it.
#[cfg(unix)]
#[test]
fn files_that_are_in_order_are_left_alone() {
    use std::os::unix::fs::MetadataExt;
    let (plan, dir) = (plan(SMALL), tempdir().unwrap());
    run_whole(&plan, dir.path());
    let files = || {
        let files = fs::read_dir(dir.path()).unwrap().map(Result::unwrap);
        let files = files.map(|file| (file.file_name(), file.metadata().unwrap().ino()));
        files.collect::<std::collections::BTreeMap<_, _>>()
    };
    let before = files();
    assert!(before.len() > 5, "{before:?}");
    run_whole(&plan, dir.path());
    assert_eq!(files(), before);
}

/// The chunks of a session, each with its text and note as another process makes them.
fn delivered(session: &mut Session, plan: &Plan) -> Vec<(String, String)> {
    let mut made = Vec::new();
    while let Step::Chunk(chunk) = session.next() {
        let one = NonZeroUsize::MIN;
        made.extend(chunk_with_note(plan, &chunk, "0.1.0 (elsewhere)", one, || true).unwrap());
    }
    made
}

#[test]
fn a_session_records_who_made_its_chunks_elsewhere() {
    let (plan, dir) = (plan(SMALL), tempdir().unwrap());
    let [here, there] = ["here", "there"].map(|name| dir.path().join(name));
    let mut session = Session::open(&plan, &there, "0.1.0 (test)", &()).unwrap();
    let made = delivered(&mut session, &plan);
    let all = made.iter().map(|(text, note)| Delivery {
        text: text.as_bytes(),
        note: note.as_bytes(),
    });
    session.accept(all).unwrap();
    session.conclude(&()).unwrap();
    let of_there = provenance(&there, &plan).unwrap();
    let [by] = &of_there.contributions[..] else {
        panic!("{of_there:?}")
    };
    assert_eq!(
        (by.maker.build.as_str(), by.chunks),
        ("0.1.0 (elsewhere)", 6)
    );
    assert_eq!((by.tosses, of_there.unrecorded_chunks), (600, 0));
    run_whole(&plan, &here);
    assert_same(&here, &there);
}

/// A note of 4096 bytes, which JSON may fill with blanks, is read.
#[test]
fn a_note_that_is_too_long_is_refused() {
    let plan = plan(SMALL);
    let mut session = Session::in_memory(&plan);
    let (text, note) = delivered(&mut session, &plan).remove(0);
    for (length, is_read) in [(4097, false), (4096, true)] {
        let note = format!("{note:length$}");
        let (text, note) = (text.as_bytes(), note.as_bytes());
        let accepted = session.accept([Delivery { text, note }]);
        assert_eq!(accepted.is_ok(), is_read, "{length}");
        if let Err(error) = accepted {
            assert!(error.to_string().contains("too long"), "{error}");
        }
        assert_eq!(session.awaited(), 6 - usize::from(is_read));
    }
}

#[test]
fn a_session_counts_what_it_asked_for_and_once() {
    let plan = plan(SMALL);
    let mut session = Session::in_memory(&plan);
    let made = delivered(&mut session, &plan);
    assert_eq!((made.len(), session.awaited()), (6, 6));
    let delivery = |index: usize| Delivery::from(made[index].0.as_bytes());
    // twice at once, and again
    session
        .accept([delivery(0), delivery(0), delivery(1)])
        .unwrap();
    assert_eq!(
        (session.awaited(), session.progress().tosses_done),
        (4, 200)
    );
    session.accept([delivery(1)]).unwrap();
    assert_eq!(
        (session.awaited(), session.progress().tosses_done),
        (4, 200)
    );
    // nobody asked
    let mut other = Session::in_memory(&plan);
    other.accept([delivery(0)]).unwrap();
    assert_eq!((other.awaited(), other.progress().tosses_done), (0, 0));
    session.accept((2..6).map(delivery)).unwrap();
    let report = session.conclude(&()).unwrap();
    assert_eq!((report.status, report.tosses), (Status::Complete, 600));
}

/// What is counted of a chunk when a run is stopped is in a file, from which the next goes on.
#[test]
fn a_run_goes_on_from_the_beginning_of_a_chunk() {
    let (plan, dir) = (plan(SMALL), tempdir().unwrap());
    let [whole, broken] = ["whole", "broken"].map(|name| dir.path().join(name));
    run_whole(&plan, &whole);
    run_with(&plan, &broken, Part::WHOLE, 1, &Ear::that_cancels_at(0)).unwrap();
    let (point, tosses) = (3, 0..40);
    let begun = Chunk { point, tosses };
    let text = text_of_tally(&plan, &begun, &run_chunk(&plan, &begun).unwrap());
    fs::write(broken.join("unfinished.txt"), text).unwrap();
    let ear = Ear::default();
    run_with(&plan, &broken, Part::WHOLE, 1, &ear).unwrap();
    let last = *ear.progress.lock().unwrap().last().unwrap();
    assert_eq!((last.tosses_reused, last.reused_chunks), (40, 0));
    assert_same(&whole, &broken);
}

/// Chunks that are in the earlier run as a whole become chunks of this one.
#[test]
fn more_points_toss_the_new_ones_only() {
    let ratios = |list| {
        plan_of(&format!(
            "[coin]\nratio = {list}\n[surface]\nrestitution = [0.3, 0.6]\n[stop]\n{SMALL}"
        ))
    };
    let (dir, ear) = (tempdir().unwrap(), Ear::default());
    let [one, at_once] = ["one", "at_once"].map(|name| dir.path().join(name));
    let more = ratios("[1.0, 2.0, 1.5]");
    run_whole(&ratios("[1.0, 2.0]"), &one);
    let report = run_with(&more, &one, Part::WHOLE, 1, &ear).unwrap();
    assert_eq!((report.tosses, report.reused_chunks), (600, 4));
    let last = *ear.progress.lock().unwrap().last().unwrap();
    assert_eq!((last.tosses_done, last.tosses_reused), (600, 400));
    run_whole(&more, &at_once);
    assert_same(&one, &at_once);
    let (_, stored) = stored_report(&one, &()).unwrap();
    assert_eq!((stored.tosses, stored.status), (600, Status::Complete));
}

#[test]
fn points_that_have_what_was_asked_for_are_told() {
    let reached = |stop| {
        let dir = tempdir().unwrap();
        let report = run_whole(&plan(stop), dir.path());
        (report.points_reached(), report.status)
    };
    assert_eq!(reached(SMALL), (6, Status::Complete));
    let short = Status::ShortOfTarget { points: 6 };
    assert_eq!(reached("half_width = 0.001\nmax_tosses = 100"), (0, short));
}

#[test]
fn an_empty_range_has_no_tosses_and_a_reversed_one_is_none() {
    let (plan, point) = (plan(SMALL), 0);
    let chunk = |tosses| run_chunk(&plan, &Chunk { point, tosses });
    assert_eq!(chunk(5..5).unwrap(), Tally::default());
    assert_eq!(chunk(5..7).unwrap().tosses(), 2);
    let reversed = std::ops::Range { start: 7, end: 5 };
    assert!(matches!(chunk(reversed), Err(RunError::NoSuchChunk { .. })));
}

#[test]
fn what_is_stored_of_chunks_is_what_they_count() {
    let (plan, dir) = (plan(SMALL), tempdir().unwrap());
    run_whole(&plan, dir.path());
    let expected = (0..6).map(|point| {
        let chunk = Chunk {
            point,
            tosses: 0..100,
        };
        let tally = run_chunk(&plan, &chunk).unwrap();
        (chunk, tally)
    });
    assert!(
        stored_chunks(dir.path(), &plan)
            .unwrap()
            .into_iter()
            .eq(expected)
    );
}

/// Another error than that of a file is no reason to call it one.
#[cfg(unix)]
#[test]
fn what_cannot_be_read_of_a_directory_is_told() {
    let (plan, dir) = (plan(SMALL), tempdir().unwrap());
    let refused = |out: &Path| run_with(&plan, out, Part::WHOLE, 1, &Ear::default()).unwrap_err();
    // longer than a name may be
    let error = refused(&dir.path().join("x".repeat(300)));
    assert!(error.to_string().starts_with("cannot "), "{error}");
    fs::create_dir(dir.path().join("manifest.json")).unwrap();
    let error = refused(dir.path());
    assert!(
        matches!(error, RunError::Io { action: "read", .. }),
        "{error}"
    );
}

#[test]
fn a_directory_is_locked_by_one_process() {
    let (plan, dir) = (plan(SMALL), tempdir().unwrap());
    run_whole(&plan, dir.path());
    let lock = || {
        let lock = fs::File::open(dir.path().join("lock")).unwrap();
        lock.try_lock().unwrap();
        lock
    };
    let run = || run_with(&plan, dir.path(), Part::WHOLE, 1, &Ear::default());
    assert!(!is_running(dir.path()));
    let held = lock();
    assert!(is_running(dir.path()));
    assert!(matches!(run(), Err(RunError::Locked { .. })));
    drop(held);
    assert!(!is_running(dir.path()));
    run().unwrap();
    // one that is released soon is waited for; a busy machine may release it too late
    let waits = || {
        let held = lock();
        std::thread::scope(|scope| {
            scope.spawn(|| {
                std::thread::sleep(std::time::Duration::from_millis(30));
                drop(held);
            });
            run().is_ok()
        })
    };
    assert!((0..10).any(|_| waits()));
}

#[test]
fn a_merge_into_a_part_is_refused() {
    let (plan, dir) = (plan(SMALL), tempdir().unwrap());
    let parts = two_parts(&plan, dir.path());
    let before = contents(&parts[0]);
    let error = merge(&parts, &parts[0], &()).unwrap_err();
    assert!(matches!(error, RunError::MergeIntoPart { .. }), "{error}");
    assert_eq!(contents(&parts[0]), before);
}

#[test]
fn a_part_that_lacks_a_chunk_of_its_own_is_not_complete() {
    let (plan, dir) = (plan(SMALL), tempdir().unwrap());
    let [part, _] = two_parts(&plan, dir.path());
    let status = || stored_report(&part, &()).unwrap().1.status;
    assert_eq!(status(), Status::Part);
    fs::write(part.join("tallies.txt"), tallies(&part)[1..].concat()).unwrap();
    assert_eq!(status(), Status::Interrupted);
}

/// A config that was changed is not that of the run, unless another version may have understood it otherwise.
#[test]
fn a_config_that_is_not_the_one_that_was_run_is_told() {
    let (plan, dir) = (plan(SMALL), tempdir().unwrap());
    run_whole(&plan, dir.path());
    assert_eq!(stored_plan(dir.path()).unwrap(), plan);
    let edit = |name: &str, from: &str, to: &str| {
        let path = dir.path().join(name);
        let text = fs::read_to_string(&path).unwrap();
        assert!(text.contains(from), "{text}");
        fs::write(&path, text.replace(from, to)).unwrap();
    };
    edit("config.toml", "seed = 7", "seed = 8");
    let error = stored_plan(dir.path()).unwrap_err();
    assert!(matches!(error, RunError::ChangedConfig { .. }), "{error}");
    edit("manifest.json", env!("CARGO_PKG_VERSION"), "9.9.9");
    let error = stored_plan(dir.path()).unwrap_err();
    assert!(matches!(error, RunError::OtherVersion { .. }), "{error}");
    let config = dir.path().join("config.toml");
    fs::remove_file(&config).unwrap();
    fs::create_dir(&config).unwrap();
    let error = stored_plan(dir.path()).unwrap_err();
    assert!(matches!(error, RunError::BadConfig { .. }), "{error}");
}

#[test]
fn tallies_that_cannot_be_read_are_told() {
    let (plan, dir) = (plan(SMALL), tempdir().unwrap());
    run_whole(&plan, dir.path());
    let tallies = dir.path().join("tallies.txt");
    fs::remove_file(&tallies).unwrap();
    assert_eq!(stored_report(dir.path(), &()).unwrap().1.tosses, 0);
    fs::create_dir(&tallies).unwrap();
    let error = stored_report(dir.path(), &()).unwrap_err();
    assert!(matches!(error, RunError::Io { .. }), "{error}");
}

#[test]
fn of_a_tally_that_occurs_twice_in_a_row_one_stays() {
    let (plan, dir) = (plan(SMALL), tempdir().unwrap());
    run_whole(&plan, dir.path());
    let before = contents(dir.path());
    let mut texts = tallies(dir.path());
    texts.insert(0, texts[0].clone());
    fs::write(dir.path().join("tallies.txt"), texts.concat()).unwrap();
    assert_eq!(run_whole(&plan, dir.path()).tosses, 600);
    assert_eq!(contents(dir.path()), before);
}

#[test]
fn what_a_killed_run_leaves_is_removed() {
    let (plan, dir) = (plan(SMALL), tempdir().unwrap());
    run_whole(&plan, dir.path());
    let before = contents(dir.path());
    for name in ["tallies.txt", "results.csv", "manifest.json", "config.toml"] {
        fs::write(dir.path().join(format!("{name}.tmp")), "?").unwrap();
    }
    run_whole(&plan, dir.path());
    assert_eq!(contents(dir.path()), before);
}

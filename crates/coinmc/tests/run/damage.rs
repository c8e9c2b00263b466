//! Damaged files are detected and recomputed; foreign directories are left alone.

use crate::support::{
    Ear, FIXED, HALF_WIDTH, contents, plan, put_tallies, resealed, run_whole, run_with, tallies,
};
use coinmc::run::{Part, RunError, Status, is_running, stored_report};
use std::fs;
use std::path::Path;
use tempfile::tempdir;

/// What is done to one of the tallies, and a word of the warning.
type Damage = (&'static str, fn(&str) -> String);

/// What is opened to be read would wait for ever where it is a pipe.
#[cfg(unix)]
#[test]
fn pipes_are_refused() {
    use std::sync::mpsc::channel;
    let (plan, dir) = (plan(FIXED), tempdir().unwrap());
    run_whole(&plan, dir.path());
    for name in [
        "manifest.json",
        "config.toml",
        "tallies.txt",
        "unfinished.txt",
        "provenance.jsonl",
    ] {
        let (path, aside) = (dir.path().join(name), dir.path().join("aside"));
        let had = fs::rename(&path, &aside).is_ok();
        let made = std::process::Command::new("mkfifo").arg(&path).status();
        assert!(made.unwrap().success());
        let (told, refused) = channel();
        let (plan, folder) = (plan.clone(), dir.path().to_owned());
        std::thread::spawn(move || {
            let report = stored_report(&folder, &Ear::default());
            let made_by = coinmc::run::provenance(&folder, &plan);
            told.send(report.is_err() || made_by.is_err())
        });
        let answer = refused.recv_timeout(std::time::Duration::from_secs(20));
        assert_eq!(answer, Ok(true), "{name}");
        fs::remove_file(&path).unwrap();
        if had {
            fs::rename(&aside, &path).unwrap();
        }
    }
    assert!(stored_report(dir.path(), &Ear::default()).is_ok());
}

#[test]
fn damaged_tallies_are_set_aside_and_recomputed() {
    let plan = plan(FIXED);
    let damages: [Damage; 8] = [
        ("checksum", |text| format!("{}\n", &text[..text.len() / 2])),
        ("checksum", |_| "mine\ncrc32 12345678\n".to_owned()),
        ("checksum", |text| {
            let mut bytes = text.as_bytes().to_vec();
            bytes[120] ^= 4;
            String::from_utf8(bytes).unwrap()
        }),
        ("longer", |text| format!("{}\n{text}", "z".repeat(1 << 20))),
        ("no such chunk", |text| {
            resealed(text, |text| text.replacen("point 1", "point 9", 1))
        }),
        ("another plan", |text| {
            resealed(text, |text| text.replacen("plan ", "plan 0", 1))
        }),
        ("version", |text| {
            resealed(text, |text| text.replacen("tally 2", "tally 1", 1))
        }),
        ("impossible", |text| {
            resealed(text, |text| text.replacen("\nheads ", "\nheads 1", 1))
        }),
    ];
    let dir = tempdir().unwrap();
    let whole = run_whole(&plan, dir.path());
    let before = contents(dir.path());
    let rejected = dir.path().join("tallies.rejected.txt");
    for (word, damage) in damages {
        let mut texts = tallies(dir.path());
        texts[4] = damage(&texts[4]);
        let bad = texts[4].clone();
        put_tallies(dir.path(), &texts);
        let ear = Ear::default();
        let report = run_with(&plan, dir.path(), Part::WHOLE, 2, &ear).unwrap();
        let warnings = ear.warnings();
        assert_eq!(warnings.len(), 1, "{word}: {warnings:?}");
        assert!(warnings[0].contains(word), "{word}: {warnings:?}");
        assert_eq!(report.results, whole.results);
        let kept = fs::read_to_string(&rejected).unwrap();
        // what only stands before a tally is rejected without it
        if word == "longer" {
            assert_eq!((report.reused_chunks, kept.len()), (18, (1 << 20) + 1));
        } else {
            assert_eq!((report.reused_chunks, kept), (17, bad), "{word}");
        }
        fs::remove_file(&rejected).unwrap();
        assert_eq!(contents(dir.path()), before, "{word}");
    }
}

/// A kill while a tally is being written leaves a part of it.
#[test]
fn a_torn_end_is_cut_off_without_a_word() {
    let (plan, dir) = (plan(FIXED), tempdir().unwrap());
    run_whole(&plan, dir.path());
    let before = contents(dir.path());
    let whole = &before["tallies.txt"];
    let last = tallies(dir.path()).pop().unwrap().len();
    for torn in [1, 2, 10, last / 2, last - 1, last] {
        let left = &whole[..whole.len() - torn];
        fs::write(dir.path().join("tallies.txt"), left).unwrap();
        let ear = Ear::default();
        let report = run_with(&plan, dir.path(), Part::WHOLE, 2, &ear).unwrap();
        assert_eq!(
            (report.reused_chunks, ear.warnings()),
            (17, vec![]),
            "{torn}"
        );
        assert_eq!(contents(dir.path()), before, "{torn}");
    }
}

#[test]
fn a_tally_that_occurs_twice_counts_once() {
    let (plan, dir) = (plan(FIXED), tempdir().unwrap());
    run_whole(&plan, dir.path());
    let before = contents(dir.path());
    let texts = tallies(dir.path());
    put_tallies(dir.path(), &[texts.clone(), texts].concat());
    let ear = Ear::default();
    let report = run_with(&plan, dir.path(), Part::WHOLE, 2, &ear).unwrap();
    assert_eq!((report.tosses, ear.warnings()), (240_000, vec![]));
    assert_eq!(contents(dir.path()), before);
}

#[test]
fn leftovers_are_removed_and_foreign_files_kept() {
    let (plan, dir) = (plan(FIXED), tempdir().unwrap());
    run_whole(&plan, dir.path());
    let mut expected = contents(dir.path());
    let leftovers = [
        "tallies.txt.tmp",
        "tallies.rejected.txt.tmp",
        "results.csv.tmp",
        "results.parquet.tmp",
        "results.partial.csv",
        "manifest.json.tmp",
    ];
    let strangers = ["tallies.old", "notes.txt"];
    for name in leftovers.iter().chain(&strangers) {
        fs::write(dir.path().join(name), "?").unwrap();
    }
    for name in strangers {
        expected.insert(name.to_owned(), b"?".to_vec());
    }
    let ear = Ear::default();
    run_with(&plan, dir.path(), Part::WHOLE, 2, &ear).unwrap();
    assert!(ear.warnings().is_empty(), "{:?}", ear.warnings());
    assert_eq!(contents(dir.path()), expected);
}

#[test]
fn tallies_beyond_where_a_point_stopped_are_set_aside() {
    let (plan, dir) = (plan(HALF_WIDTH), tempdir().unwrap());
    run_whole(&plan, dir.path());
    let before = contents(dir.path());
    let mut texts = tallies(dir.path());
    let forged = resealed(&texts[0], |text| {
        let count = |name: &str| -> u64 {
            let line = text.lines().find(|line| line.starts_with(name)).unwrap();
            line.rsplit_once(' ').unwrap().1.parse().unwrap()
        };
        let heads = count("heads") + 32_768 - 64;
        text.replace("tosses 0 64", "tosses 524288 557056").replace(
            &format!("heads {}", count("heads")),
            &format!("heads {heads}"),
        )
    });
    texts.insert(1, forged.clone());
    put_tallies(dir.path(), &texts);
    let ear = Ear::default();
    run_with(&plan, dir.path(), Part::WHOLE, 2, &ear).unwrap();
    let warnings = ear.warnings();
    assert!(
        warnings.len() == 1 && warnings[0].contains("does not belong to this run"),
        "{warnings:?}"
    );
    let rejected = dir.path().join("tallies.rejected.txt");
    assert_eq!(fs::read_to_string(&rejected).unwrap(), forged);
    fs::remove_file(rejected).unwrap();
    assert_eq!(contents(dir.path()), before);
}

fn refused(dir: &Path, stop: &str, part: &str) -> RunError {
    let before = dir.is_dir().then(|| contents(dir));
    let part = part.parse().unwrap();
    let error = run_with(&plan(stop), dir, part, 2, &Ear::default()).unwrap_err();
    assert_eq!(
        before,
        dir.is_dir().then(|| contents(dir)),
        "a refused directory was touched"
    );
    error
}

#[test]
fn foreign_directories_are_rejected_and_untouched() {
    let dir = tempdir().unwrap();
    let file = dir.path().join("file");
    fs::write(&file, "mine").unwrap();
    assert!(matches!(
        refused(dir.path(), FIXED, "1/1"),
        RunError::NotARunDirectory { .. }
    ));
    assert!(matches!(
        refused(&file, FIXED, "1/1"),
        RunError::NotARunDirectory { .. }
    ));

    let run = dir.path().join("run");
    let ear = Ear::that_cancels_at(0);
    let report = run_with(&plan(FIXED), &run, Part::WHOLE, 2, &ear).unwrap();
    assert_eq!(report.status, Status::Interrupted);
    assert!(matches!(
        refused(&run, "tosses = 39_999", "1/1"),
        RunError::OtherPlan { .. }
    ));
    assert!(matches!(
        refused(&run, FIXED, "1/2"),
        RunError::OtherPart { .. }
    ));

    let manifest = run.join("manifest.json");
    let text = fs::read_to_string(&manifest).unwrap();
    let version = env!("CARGO_PKG_VERSION");
    fs::write(&manifest, text.replace(version, "9.9.9")).unwrap();
    assert!(matches!(
        refused(&run, FIXED, "1/1"),
        RunError::OtherVersion { .. }
    ));
    fs::write(&manifest, "{\"format\": 3, \"new\": true}").unwrap();
    assert!(matches!(
        refused(&run, FIXED, "1/1"),
        RunError::NewerFormat { found: 3, .. }
    ));
    fs::write(&manifest, "{\"format\": 1}").unwrap();
    assert!(matches!(
        refused(&run, FIXED, "1/1"),
        RunError::OlderFormat { found: 1, .. }
    ));
    for bad in [
        "",
        "[]",
        "{\"format\": 2}",
        &format!("{text}{}", " ".repeat(70_000)),
    ] {
        fs::write(&manifest, bad).unwrap();
        assert!(
            matches!(refused(&run, FIXED, "1/1"), RunError::BadManifest { .. }),
            "{bad:.20}"
        );
    }
}

#[test]
fn a_directory_in_use_is_rejected() {
    let (plan, dir) = (plan(FIXED), tempdir().unwrap());
    run_whole(&plan, dir.path());
    assert!(!is_running(dir.path()));
    let lock = fs::File::open(dir.path().join("lock")).unwrap();
    lock.try_lock().unwrap();
    assert!(is_running(dir.path()));
    let refused = run_with(&plan, dir.path(), Part::WHOLE, 2, &Ear::default());
    assert!(matches!(refused, Err(RunError::Locked { .. })));
    drop(lock);
    assert!(!is_running(dir.path()));
    run_whole(&plan, dir.path());
}

#[cfg(unix)]
#[test]
fn links_are_not_written_through() {
    use std::os::unix::fs::symlink;
    let (plan, dir) = (plan(FIXED), tempdir().unwrap());
    let (run, precious) = (dir.path().join("run"), dir.path().join("precious"));
    fs::write(&precious, "kept").unwrap();
    run_whole(&plan, &run);
    let before = contents(&run);
    for name in ["results.csv", "config.toml"] {
        fs::remove_file(run.join(name)).unwrap();
        symlink(&precious, run.join(name)).unwrap();
    }
    run_whole(&plan, &run);
    assert_eq!(contents(&run), before);
    assert_eq!(fs::read_to_string(&precious).unwrap(), "kept");

    for name in ["lock", "tallies.txt"] {
        let away = dir.path().join("away");
        fs::rename(run.join(name), &away).unwrap();
        symlink(&away, run.join(name)).unwrap();
        let refused = run_with(&plan, &run, Part::WHOLE, 2, &Ear::default());
        assert!(
            matches!(refused, Err(RunError::NotARunDirectory { .. })),
            "{name}"
        );
        fs::remove_file(run.join(name)).unwrap();
        fs::rename(&away, run.join(name)).unwrap();
    }
}

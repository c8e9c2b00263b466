//! Damaged files are detected and recomputed; foreign directories are left alone.

use crate::support::{Ear, FIXED, HALF_WIDTH, contents, plan, run_whole, run_with};
use coinmc::run::{Part, RunError, Status};
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::tempdir;

fn tallies(dir: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(dir.join("tallies")).unwrap();
    let mut paths: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths
}

type Damage = fn(&Path, &Path);

#[test]
fn damaged_tallies_are_set_aside_and_recomputed() {
    let plan = plan(FIXED);
    let damages: [(&str, Damage); 9] = [
        ("checksum", |path, _| {
            let bytes = fs::read(path).unwrap();
            fs::write(path, &bytes[..bytes.len() / 2]).unwrap();
        }),
        ("checksum", |path, _| fs::write(path, "").unwrap()),
        ("checksum", |path, _| {
            let mut bytes = fs::read(path).unwrap();
            bytes[120] ^= 4;
            fs::write(path, bytes).unwrap();
        }),
        ("another chunk", |path, other| {
            assert!(fs::copy(other, path).is_ok());
        }),
        ("longer", |path, _| {
            let file = fs::OpenOptions::new().write(true).open(path).unwrap();
            file.set_len(1 << 40).unwrap(); // sparse: reading all of it would not end well
        }),
        ("regular file", |path, _| {
            fs::remove_file(path).unwrap();
            fs::create_dir(path).unwrap();
        }),
        ("another plan", |path, _| {
            reseal(path, |text| text.replacen("plan ", "plan 0", 1));
        }),
        ("version", |path, _| {
            reseal(path, |text| text.replacen("tally 2", "tally 1", 1));
        }),
        ("impossible", |path, _| {
            reseal(path, |text| text.replacen("\nheads ", "\nheads 1", 1));
        }),
    ];
    let dir = tempdir().unwrap();
    let whole = run_whole(&plan, dir.path());
    let before = contents(dir.path());
    for (word, damage) in damages {
        let files = tallies(dir.path());
        let (victim, other) = (&files[4], &files[5]);
        damage(victim, other);
        let ear = Ear::default();
        let report = run_with(&plan, dir.path(), Part::WHOLE, 2, &ear).unwrap();
        let warnings = ear.warnings();
        assert_eq!(warnings.len(), 1, "{word}: {warnings:?}");
        assert!(warnings[0].contains(word), "{word}: {warnings:?}");
        assert_eq!(report.results, whole.results);
        assert_eq!(report.reused_chunks, 17);
        let rejected = PathBuf::from(format!("{}.rejected", victim.display()));
        if rejected.is_dir() {
            fs::remove_dir(rejected).unwrap();
        } else {
            fs::remove_file(rejected).unwrap();
        }
        assert_eq!(contents(dir.path()), before, "{word}");
    }
}

/// Alters a tally file and gives it a right checksum again (CRC-32 as in zlib).
fn reseal(path: &Path, alter: impl Fn(String) -> String) {
    let text = alter(fs::read_to_string(path).unwrap());
    let body = text.rsplit_once("crc32 ").unwrap().0;
    let mut crc = u32::MAX;
    for byte in body.bytes() {
        crc ^= u32::from(byte);
        for _ in 0..8 {
            crc = if crc & 1 == 1 {
                (crc >> 1) ^ 0xEDB8_8320
            } else {
                crc >> 1
            };
        }
    }
    fs::write(path, format!("{body}crc32 {:08x}\n", !crc)).unwrap();
}

#[test]
fn leftovers_are_removed_and_foreign_files_kept() {
    let (plan, dir) = (plan(FIXED), tempdir().unwrap());
    run_whole(&plan, dir.path());
    let mut expected = contents(dir.path());
    let leftovers = [
        "tallies/p000000-t00000000000000.tally.tmp",
        "results.csv.tmp",
        "results.parquet.tmp",
        "results.partial.csv",
        "manifest.json.tmp",
    ];
    let strangers = ["tallies/README", "tallies/p1-t0.tally", "notes.txt"];
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
    let forged = dir.path().join("tallies/p000000-t00000000524288.tally");
    fs::copy(&tallies(dir.path())[0], &forged).unwrap();
    reseal(&forged, |text| {
        let count = |name: &str| -> u64 {
            let line = text.lines().find(|line| line.starts_with(name)).unwrap();
            line.rsplit_once(' ').unwrap().1.parse().unwrap()
        };
        let heads = count("heads") + 32_768 - 1024;
        text.replace("tosses 0 1024", "tosses 524288 557056")
            .replace(
                &format!("heads {}", count("heads")),
                &format!("heads {heads}"),
            )
    });
    let ear = Ear::default();
    run_with(&plan, dir.path(), Part::WHOLE, 2, &ear).unwrap();
    let warnings = ear.warnings();
    assert!(
        warnings.len() == 1 && warnings[0].contains("does not belong to this run"),
        "{warnings:?}"
    );
    fs::remove_file(format!("{}.rejected", forged.display())).unwrap();
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
        refused(&run, "tosses = 40_001", "1/1"),
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
    fs::write(&manifest, "{\"format\": 2, \"new\": true}").unwrap();
    assert!(matches!(
        refused(&run, FIXED, "1/1"),
        RunError::NewerFormat { found: 2, .. }
    ));
    for bad in [
        "",
        "[]",
        "{\"format\": 1}",
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
    let lock = fs::File::open(dir.path().join("lock")).unwrap();
    lock.try_lock().unwrap();
    let refused = run_with(&plan, dir.path(), Part::WHOLE, 2, &Ear::default());
    assert!(matches!(refused, Err(RunError::Locked { .. })));
    drop(lock);
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
    for name in [
        "results.csv",
        "config.toml",
        "tallies/p000000-t00000000000000.tally",
    ] {
        fs::remove_file(run.join(name)).unwrap();
        symlink(&precious, run.join(name)).unwrap();
    }
    run_whole(&plan, &run);
    fs::remove_file(run.join("tallies/p000000-t00000000000000.tally.rejected")).unwrap();
    assert_eq!(contents(&run), before);
    assert_eq!(fs::read_to_string(&precious).unwrap(), "kept");

    for name in ["lock", "tallies"] {
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

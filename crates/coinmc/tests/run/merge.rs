//! Parts and their merge.

use crate::support::{
    Ear, FIXED, HALF_WIDTH, LONG, assert_same, contents, plan, put_tallies, resealed, run_whole,
    run_with, tallies,
};
use coinmc::run::{Chunk, Part, RunError, Status, merge, merge_what_is_there, stored_report};
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::tempdir;

fn run_parts(dir: &Path, of: u32) -> Vec<PathBuf> {
    let run_part = |index| {
        let out = dir.join(format!("part{index}"));
        let part = Part::new(index, of).unwrap();
        let report = run_with(&plan(FIXED), &out, part, 2, &Ear::default()).unwrap();
        assert_eq!(report.status, Status::Part);
        assert!(!contents(&out).contains_key("results.csv"));
        out
    };
    (1..=of).map(run_part).collect()
}

#[test]
fn merged_parts_equal_the_whole_run_to_the_byte() {
    let dir = tempdir().unwrap();
    let whole = dir.path().join("whole");
    let report = run_whole(&plan(FIXED), &whole);
    for of in [2, 5, 30] {
        let dir = tempdir().unwrap();
        let parts = run_parts(dir.path(), of);
        let before: Vec<_> = parts.iter().map(|part| contents(part)).collect();
        let merged = dir.path().join("merged");
        let again = merge(&parts, &merged, &()).unwrap();
        assert_eq!(again.status, Status::Complete);
        assert_eq!(again.results, report.results);
        assert_same(&whole, &merged);
        let after: Vec<_> = parts.iter().map(|part| contents(part)).collect();
        assert!(before == after, "a part was touched");
        // merging again, or a whole with its parts, is no harm
        merge(&[parts, vec![whole.clone()]].concat(), &merged, &()).unwrap();
        assert_same(&whole, &merged);
    }
}

/// The machine that merges has tossed nothing.
#[test]
fn a_merged_run_names_the_machines_that_tossed() {
    let dir = tempdir().expect("a directory");
    let parts = run_parts(dir.path(), 2);
    let manifest = |dir: &Path| -> serde_json::Value {
        let text = fs::read_to_string(dir.join("manifest.json")).expect("a manifest");
        serde_json::from_str(&text).expect("JSON")
    };
    let machines = ["another processor", "one processor"];
    for (part, machine) in parts.iter().zip(machines) {
        let mut elsewhere = manifest(part);
        elsewhere["targets"] = [machine].into();
        fs::write(part.join("manifest.json"), elsewhere.to_string()).expect("a written file");
    }
    let merged = dir.path().join("merged");
    merge(&parts, &merged, &()).expect("both parts of a run");
    assert_eq!(manifest(&merged)["targets"], serde_json::json!(machines));
}

#[test]
fn missing_chunks_are_named_and_nothing_is_written() {
    let dir = tempdir().unwrap();
    let parts = run_parts(dir.path(), 3);
    let out = dir.path().join("merged");
    let error = merge(&parts[..2], &out, &()).unwrap_err();
    // every third of the full chunks, two a point, and of the short ones, one a point
    let RunError::Missing(missing) = &error else {
        panic!("{error}")
    };
    assert_eq!((missing.total, missing.array()), (6, "3".to_owned()));
    assert_eq!(
        missing.chunks[1],
        Chunk {
            point: 2,
            tosses: 16_384..40_000
        }
    );
    assert!(
        error.to_string().contains("point 2, tosses 16384..40000"),
        "{error}"
    );
    assert!(!out.exists());

    // a damaged tally is missing too, and said to be damaged
    let mut texts = tallies(&parts[0]);
    texts[0] = "x\ncrc32 0\n".to_owned();
    put_tallies(&parts[0], &texts);
    let before = contents(&parts[0]);
    let ear = Ear::default();
    let error = merge(&parts, &out, &ear).unwrap_err();
    let RunError::Missing(missing) = &error else {
        panic!("{error}")
    };
    assert_eq!((missing.total, missing.array()), (1, "1".to_owned()));
    let path = parts[0].join("tallies.txt");
    assert!(
        ear.warnings()[0].contains(path.to_str().unwrap()),
        "{:?}",
        ear.warnings()
    );
    assert_eq!(contents(&parts[0]), before);
}

#[test]
fn neighbouring_missing_chunks_are_named_together() {
    let dir = tempdir().unwrap();
    let out = dir.path().join("run");
    run_with(&plan(LONG), &out, Part::WHOLE, 1, &Ear::that_cancels_at(1)).unwrap();
    let error = merge(&[out], &dir.path().join("merged"), &()).unwrap_err();
    let RunError::Missing(missing) = &error else {
        panic!("{error}")
    };
    assert_eq!(missing.parts, []);
    assert_eq!(
        missing.chunks.last(),
        Some(&Chunk {
            point: 5,
            tosses: 0..200_000
        })
    );
    // all are named
    assert!(!error.to_string().contains('…'), "{error}");
}

/// Two of three parts make a run that was stopped; with the third it is the whole.
#[test]
fn what_parts_there_are_make_a_run_that_was_stopped() {
    let (plan, dir) = (plan(FIXED), tempdir().unwrap());
    let parts = [1, 2, 3].map(|i| dir.path().join(format!("part-{i}")));
    for (i, out) in (1..).zip(&parts) {
        let part = Part::new(i, 3).unwrap();
        run_with(&plan, out, part, 2, &Ear::default()).unwrap();
    }
    let status = |part: &Path| stored_report(part, &Ear::default()).unwrap().1.status;
    assert_eq!(status(&parts[0]), Status::Part);
    let (whole, direct) = (dir.path().join("whole"), dir.path().join("direct"));
    let (report, missing) = merge_what_is_there(&parts[..2], &whole, &Ear::default()).unwrap();
    assert_eq!(report.status, Status::Interrupted);
    let missing = missing.unwrap();
    assert_eq!(missing.names(), "3/3");
    let lacking = missing.total;
    let tosses: u64 = parts[..2]
        .iter()
        .map(|part| stored_report(part, &Ear::default()).unwrap().1.tosses)
        .sum();
    assert_eq!(report.tosses, tosses);
    assert!(contents(&whole).contains_key("results.partial.csv"));
    // what is there counts, whatever is merged into it
    let (again, missing) = merge_what_is_there(&parts[..1], &whole, &Ear::default()).unwrap();
    assert_eq!((again.tosses, missing.unwrap().total), (tosses, lacking));
    let report = merge(&parts[2..], &whole, &Ear::default()).unwrap();
    assert_eq!(report.status, Status::Complete);
    assert_eq!(status(&whole), Status::Complete);
    fs::remove_file(parts[0].join("tallies.txt")).unwrap();
    assert_eq!(status(&parts[0]), Status::Interrupted);
    run_whole(&plan, &direct);
    assert_same(&whole, &direct);
}

#[test]
fn parts_that_disagree_are_rejected() {
    let dir = tempdir().unwrap();
    let parts = run_parts(dir.path(), 2);
    let (forged, out) = (dir.path().join("forged"), dir.path().join("merged"));
    // a plan's own tally with other counts, rightly sealed: made by the same plan's name
    fs::create_dir_all(&forged).unwrap();
    for file in ["manifest.json", "config.toml"] {
        fs::copy(parts[0].join(file), forged.join(file)).unwrap();
    }
    let text = resealed(&tallies(&parts[0])[0], |text| {
        let mut lines = text.lines();
        let line = lines.find(|line| line.starts_with("impacts")).unwrap();
        text.replace(line, "impacts 1")
    });
    put_tallies(&forged, &[text]);
    let all = [parts, vec![forged]].concat();
    let error = merge(&all, &out, &()).unwrap_err();
    assert!(matches!(error, RunError::Conflict { .. }), "{error}");
    assert!(!out.exists());
}

#[test]
fn invalid_merges_are_rejected() {
    let dir = tempdir().unwrap();
    let parts = run_parts(dir.path(), 2);
    let out = dir.path().join("merged");
    assert!(matches!(
        merge(&[], &out, &()),
        Err(RunError::NothingToMerge)
    ));
    assert!(matches!(
        merge(&parts, &parts[0], &()),
        Err(RunError::MergeIntoPart { .. })
    ));
    let nothing = dir.path().join("nothing");
    let with_nothing = [parts.clone(), vec![nothing.clone()]].concat();
    assert!(matches!(
        merge(&with_nothing, &out, &()),
        Err(RunError::NoRun { .. })
    ));

    let other = dir.path().join("other");
    run_whole(&plan("tosses = 100"), &other);
    let error = merge(&[parts.clone(), vec![other.clone()]].concat(), &out, &()).unwrap_err();
    let changes = "(stop.tosses 100 -> 40000)";
    assert!(error.to_string().contains(changes), "{error}");
    let several = [vec![nothing], parts.clone(), vec![other.clone()]].concat();
    let error = merge(&several, &out, &()).unwrap_err();
    let told = error.to_string();
    assert!(matches!(error, RunError::Several(_)), "{told}");
    assert!(
        told.contains("no such directory") && told.contains(changes),
        "{told}"
    );
    let error = merge(&parts, &other, &()).unwrap_err();
    assert!(error.to_string().contains(changes), "{error}");

    let config = parts[0].join("config.toml");
    let text = fs::read_to_string(&config).unwrap();
    fs::write(
        &config,
        format!(
            "# the seed is another\n{}",
            text.replace("seed = 7", "seed = 8")
        ),
    )
    .unwrap();
    let error = merge(&parts, &out, &()).unwrap_err().to_string();
    assert!(error.contains("is not the config that was run"), "{error}");
    fs::write(&config, "seed = ").unwrap();
    assert!(matches!(
        merge(&parts, &out, &()),
        Err(RunError::BadConfig { .. })
    ));
    assert!(!out.exists());
}

#[test]
fn a_run_to_a_half_width_has_no_parts_but_can_be_merged_alone() {
    let (plan, dir) = (plan(HALF_WIDTH), tempdir().unwrap());
    let (whole, merged) = (dir.path().join("whole"), dir.path().join("merged"));
    let half = Part::new(1, 2).unwrap();
    let refused = run_with(&plan, &whole, half, 2, &Ear::default());
    assert!(matches!(refused, Err(RunError::PartsNeedFixedTosses)));
    assert!(!whole.exists());
    run_whole(&plan, &whole);
    merge(std::slice::from_ref(&whole), &merged, &()).unwrap();
    assert_same(&whole, &merged);
}

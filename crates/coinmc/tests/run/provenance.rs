//! Who made the chunks of a run is told, and does not enter what is counted.

use crate::support::{
    Ear, FIXED, HALF_WIDTH, LONG, assert_same, plan, put_tallies, run_as_build, run_whole,
    run_with, tallies,
};
use coinmc::plan::Plan;
use coinmc::run::{Contribution, Part, Provenance, RunError, merge, provenance, stored_report};
use std::fs;
use std::path::Path;
use tempfile::tempdir;

const FILE: &str = "provenance.jsonl";
const BUILDS: [&str; 2] = ["0.1.0 (1111111 2026-01-01)", "0.1.0 (2222222 2026-01-02)"];

fn of(dir: &Path, plan: &Plan) -> Provenance {
    provenance(dir, plan).unwrap()
}

fn builds(provenance: &Provenance) -> Vec<&str> {
    let contributions = provenance.contributions.iter();
    contributions
        .map(|done| done.maker.build.as_str())
        .collect()
}

fn sum(provenance: &Provenance, of: impl Fn(&Contribution) -> u64) -> u64 {
    provenance.contributions.iter().map(of).sum()
}

#[test]
fn every_chunk_of_a_run_has_a_maker_whoever_went_on_with_it() {
    for stop in [LONG, HALF_WIDTH] {
        let (plan, dir) = (plan(stop), tempdir().unwrap());
        let run_by =
            |build, ear: &Ear| run_as_build(build, &plan, dir.path(), Part::WHOLE, 2, ear).unwrap();
        run_by(BUILDS[0], &Ear::that_cancels_at(2));
        let begun = of(dir.path(), &plan);
        assert_eq!(builds(&begun), BUILDS[..1]);
        let report = run_by(BUILDS[1], &Ear::default());

        let made = of(dir.path(), &plan);
        assert_eq!(
            (builds(&made), made.unrecorded_chunks),
            (BUILDS.to_vec(), 0)
        );
        assert_eq!(made.contributions[0], begun.contributions[0]);
        assert_eq!(
            sum(&made, |done| done.chunks),
            tallies(dir.path()).len() as u64
        );
        assert_eq!(sum(&made, |done| done.tosses), report.tosses);
        for done in &made.contributions {
            assert!(!done.wall.is_zero() && !done.maker.cpu.is_empty());
            assert!(done.maker.target.starts_with(std::env::consts::ARCH));
            assert!(done.processor.is_none_or(|time| !time.is_zero()));
            assert!(["scalar", "avx2", "avx512"].contains(&done.maker.lanes.as_str()));
        }
        // a finished run is made by nobody else
        let before = fs::read(dir.path().join(FILE)).unwrap();
        run_by(BUILDS[0], &Ear::default());
        assert_eq!(fs::read(dir.path().join(FILE)).unwrap(), before);
    }
}

#[test]
fn a_merged_run_tells_what_made_it() {
    let (plan, dir) = (plan(FIXED), tempdir().unwrap());
    let at = |name: &str| dir.path().join(name);
    let parts = [at("1"), at("2"), at("3")];
    for (index, out) in (1..).zip(&parts) {
        let build = BUILDS[usize::from(index == 2)];
        let part = Part::new(index, 3).unwrap();
        run_as_build(build, &plan, out, part, 1, &Ear::default()).unwrap();
    }
    let merged = at("merged");
    merge(&parts, &merged, &()).unwrap();
    let made = of(&merged, &plan);
    assert_eq!(
        (builds(&made), made.unrecorded_chunks),
        (BUILDS.to_vec(), 0)
    );
    assert_eq!(made.contributions[0].chunks, 12);
    assert_eq!(made.contributions[1], of(&parts[1], &plan).contributions[0]);
    // again adds nothing, and a part without a record tells nothing
    let before = fs::read(merged.join(FILE)).unwrap();
    merge(&parts, &merged, &()).unwrap();
    assert_eq!(fs::read(merged.join(FILE)).unwrap(), before);
    fs::remove_file(parts[0].join(FILE)).unwrap();
    merge(&parts, &at("other"), &()).unwrap();
    let made = of(&at("other"), &plan);
    assert_eq!(made.unrecorded_chunks, 6);
    assert_same(&at("other"), &merged);
}

#[test]
fn a_chunk_that_is_made_again_was_made_by_the_last() {
    let (plan, dir) = (plan(FIXED), tempdir().unwrap());
    run_as_build(
        BUILDS[0],
        &plan,
        dir.path(),
        Part::WHOLE,
        1,
        &Ear::default(),
    )
    .unwrap();
    let all = tallies(dir.path());
    put_tallies(dir.path(), &all[1..]);
    // as a kill leaves it
    let file = dir.path().join(FILE);
    let mut bytes = fs::read(&file).unwrap();
    bytes.extend(b"{\"made_by\":\"12");
    fs::write(&file, bytes).unwrap();
    run_as_build(
        BUILDS[1],
        &plan,
        dir.path(),
        Part::WHOLE,
        1,
        &Ear::default(),
    )
    .unwrap();
    let made = of(dir.path(), &plan);
    let chunks: Vec<_> = made.contributions.iter().map(|done| done.chunks).collect();
    assert_eq!((builds(&made), chunks), (BUILDS.to_vec(), vec![17, 1]));
}

#[test]
fn damage_to_the_record_costs_the_record_and_no_count() {
    let (plan, dir) = (plan(FIXED), tempdir().unwrap());
    let report = run_whole(&plan, dir.path());
    let file = dir.path().join(FILE);
    let text = fs::read_to_string(&file).unwrap();
    // the end of a line that is too long is not a line
    let longer = format!("{text}{}{{\"format\":2}}\n", "x".repeat(128 * 4096));
    for (damaged, unrecorded) in [
        (String::new(), 18),
        (text.replace("\"chunks\":[", "\"chunks\":[7,"), 18),
        (text.replace("\"lanes\"", "\"lane\""), 18),
        (longer, 0),
    ] {
        fs::write(&file, damaged).unwrap();
        assert_eq!(of(dir.path(), &plan).unrecorded_chunks, unrecorded);
        let (_, again) = stored_report(dir.path(), &()).unwrap();
        assert_eq!(again.results, report.results);
    }
    fs::write(&file, text.replace("\"format\":1", "\"format\":2")).unwrap();
    let error = provenance(dir.path(), &plan).unwrap_err();
    assert!(
        matches!(
            error,
            RunError::NewerFormat {
                found: 2,
                known: 1,
                ..
            }
        ),
        "{error}"
    );
}

#[cfg(unix)]
#[test]
fn a_record_that_is_a_link_is_not_written_to() {
    let (plan, dir) = (plan(LONG), tempdir().unwrap());
    let precious = dir.path().join("precious");
    fs::write(&precious, "kept").unwrap();
    let run = dir.path().join("run");
    run_with(&plan, &run, Part::WHOLE, 1, &Ear::that_cancels_at(1)).unwrap();
    fs::remove_file(run.join(FILE)).unwrap();
    std::os::unix::fs::symlink(&precious, run.join(FILE)).unwrap();
    let error = run_with(&plan, &run, Part::WHOLE, 1, &Ear::default()).unwrap_err();
    assert!(error.to_string().contains(FILE), "{error}");
    assert_eq!(fs::read_to_string(&precious).unwrap(), "kept");
}

//! A disk without room: a clear error, and the run goes on when there is room again.
//!
//! A limit on the size of files stands in for the disk: like a full one it makes writes fail
//! half-way. The shell ignores the signal that comes with it, and so does what it starts.
#![cfg(unix)]

use crate::support::{Ear, FIXED, assert_same, contents, plan, run_whole, run_with, tallies};
use coinmc::run::{Part, RunError, Status};
use std::path::Path;
use std::process::Command;
use tempfile::tempdir;

/// Name of the environment variable that tells the child where to run.
const CHILD: &str = "COINMC_TEST_RUN_DIRECTORY";

/// Not a test of its own: what the next test starts under a limit.
#[test]
fn child_with_a_limit() {
    let Some(out) = std::env::var_os(CHILD) else {
        return;
    };
    let result = run_with(&plan(FIXED), out.as_ref(), Part::WHOLE, 2, &Ear::default());
    let error = result.expect_err("there is a limit");
    assert!(matches!(error, RunError::OutOfSpace { .. }), "{error}");
    assert!(error.to_string().contains("run again"), "{error}");
}

/// Runs the child where no file may be longer than `blocks` (of 512 or 1024 bytes: shells differ).
fn run_limited(out: &Path, blocks: u32) {
    let output = Command::new("sh")
        .arg("-c")
        .arg(format!(
            "trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" \"$@\""
        ))
        .arg(std::env::current_exe().unwrap())
        .args(["full_disk::child_with_a_limit", "--exact"])
        .env(CHILD, out)
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stdout)
    );
}

#[test]
fn a_full_disk_is_reported_and_the_run_resumes_later() {
    let (plan, dir) = (plan(FIXED), tempdir().unwrap());
    let (whole, full) = (dir.path().join("whole"), dir.path().join("full"));
    run_whole(&plan, &whole);
    // 0: not even the manifest. 2: config and some tallies, of some 300 bytes each, but no results.
    for blocks in [0, 2] {
        run_limited(&full, blocks);
        let files = contents(&full);
        assert!(!files.contains_key("results.csv") && !files.contains_key("results.parquet"));
        assert!(
            files.keys().all(|name| !name.contains(".tmp")),
            "{:?}",
            files.keys()
        );
    }
    let kept = tallies(&full).len() as u64;
    assert!(kept < 18);
    let ear = Ear::default();
    let report = run_with(&plan, &full, Part::WHOLE, 2, &ear).unwrap();
    assert_eq!(
        (report.status, report.reused_chunks),
        (Status::Complete, kept)
    );
    assert!(ear.warnings().is_empty(), "{:?}", ear.warnings());
    assert_same(&whole, &full);
}

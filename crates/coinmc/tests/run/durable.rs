//! What a run has counted outlasts a loss of power.
#![cfg(target_os = "linux")]

use crate::support::{Ear, plan, run_with};
use coinmc::run::{Part, Status};
use coinmc_testkit::durable::{PLACE, Promise};
use std::fs;
use tempfile::tempdir;

/// Not a test of its own: what the next test watches.
#[test]
fn child_that_is_watched() {
    let Some(out) = std::env::var_os(PLACE) else {
        return;
    };
    let plan = plan("tosses = 20_000");
    let report = run_with(&plan, out.as_ref(), Part::WHOLE, 1, &Ear::default()).unwrap();
    assert_eq!(report.status, Status::Complete);
}

#[test]
fn a_loss_of_power_takes_no_tally_and_no_result() {
    let dir = tempdir().unwrap();
    let out = dir.path().join("run");
    let promise = Promise {
        root: &out,
        by_the_line: &["tallies.txt"],
        // nobody needs the lock, who counted what is told, but not needed
        expendable: &["lock", "provenance.jsonl", "unfinished.txt"],
    };
    let watch = || promise.broken_by("durable::child_that_is_watched");
    let Some(broken) = watch() else {
        return;
    };
    assert_eq!(broken, [""; 0]);
    // a run that was killed while it wrote goes on as safely
    let tallies = out.join("tallies.txt");
    let whole = fs::read(&tallies).unwrap();
    fs::write(&tallies, &whole[..whole.len() - 40]).unwrap();
    for results in ["results.csv", "results.parquet"] {
        let _ = fs::remove_file(out.join(results));
    }
    assert_eq!(watch().unwrap(), [""; 0]);
    assert_eq!(fs::read(&tallies).unwrap().len(), whole.len());
}

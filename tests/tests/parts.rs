//! However a run is shared out, it ends in the same bytes.

use coinmc_tests::{command, snapshot};
use std::fs;
use std::path::Path;
use std::process::Output;

const CONFIG: &str = "\
[coin]
ratio = [0.8, 1.6]
[surface]
restitution = [0.0, 0.5]
friction = 0.3
[launch]
preset = \"robot\"
[engine.flat]
[stop]
tosses = 70_000
";

/// The same by the engine in space, by a law that is not its default.
const IN_SPACE: &str = "\
[coin]
ratio = [0.85, 2.0]
[surface]
restitution = 0.5
friction = 0.3
rolling_friction_m = 1e-4
pivoting_friction_m = 1e-4
[launch]
preset = \"clean\"
[engine.volumetric]
law = \"chatterjee-ruina\"
[stop]
tosses = 40_000
";

fn coinmc(dir: &Path, arguments: &[&str]) -> Output {
    command(dir)
        .args(arguments)
        .output()
        .expect("coinmc starts")
}

fn succeed(dir: &Path, arguments: &[&str]) {
    let output = coinmc(dir, arguments);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {stderr}");
}

fn bench() -> tempfile::TempDir {
    bench_of(CONFIG)
}

fn bench_of(config: &str) -> tempfile::TempDir {
    let dir = tempfile::tempdir().expect("a temporary directory");
    fs::write(dir.path().join("toss.toml"), config).expect("the config can be written");
    dir
}

#[test]
fn parts_merged_are_one_run_to_the_byte() {
    for config in [CONFIG, IN_SPACE] {
        parts_are_merged(bench_of(config).path());
    }
}

fn parts_are_merged(dir: &Path) {
    succeed(dir, &["run", "toss.toml", "--out", "whole"]);
    for part in ["1/3", "2/3", "3/3"] {
        let out = format!("part-{}", &part[..1]);
        succeed(dir, &["run", "toss.toml", "--shard", part, "--out", &out]);
    }
    let parts = ["part-3", "part-1", "part-2"];
    let untouched = parts.map(|part| snapshot(&dir.join(part)));
    succeed(
        dir,
        &["merge", parts[0], parts[1], parts[2], "--out", "merged"],
    );
    assert!(snapshot(&dir.join("whole")) == snapshot(&dir.join("merged")));
    assert!(
        untouched == parts.map(|part| snapshot(&dir.join(part))),
        "parts are only read"
    );
}

#[test]
fn a_missing_part_is_named_and_nothing_is_written() {
    let dir = bench();
    let dir = dir.path();
    succeed(
        dir,
        &["run", "toss.toml", "--shard", "1/2", "--out", "part-1"],
    );
    let output = coinmc(dir, &["merge", "part-1", "--out", "merged"]);
    assert_eq!(output.status.code(), Some(2));
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(stderr.contains("in none of the parts"), "{stderr}");
    assert!(!dir.join("merged").exists());
}

#[test]
fn parts_of_different_runs_do_not_mix() {
    let dir = bench();
    let dir = dir.path();
    succeed(
        dir,
        &["run", "toss.toml", "--shard", "1/2", "--out", "part-1"],
    );
    succeed(
        dir,
        &[
            "run",
            "toss.toml",
            "--shard",
            "2/2",
            "--out",
            "part-2",
            "--set",
            "seed=2",
        ],
    );
    let output = coinmc(dir, &["merge", "part-1", "part-2", "--out", "merged"]);
    assert_eq!(
        output.status.code(),
        Some(2),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    assert!(!dir.join("merged").exists());
}

#[test]
fn threads_change_nothing() {
    for config in [CONFIG, IN_SPACE] {
        let dir = bench_of(config);
        let dir = dir.path();
        for threads in ["1", "2", "7"] {
            succeed(
                dir,
                &["run", "toss.toml", "--threads", threads, "--out", threads],
            );
        }
        let one = snapshot(&dir.join("1"));
        assert!(one == snapshot(&dir.join("2")) && one == snapshot(&dir.join("7")));
    }
}

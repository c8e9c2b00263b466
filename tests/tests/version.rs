//! The program says which build it is, and a run directory remembers it.

use coinmc_tests::{command, root};
use std::fs;
use std::process::Command;

/// What `coinmc --version` prints after the name of the program.
fn build(dir: &std::path::Path) -> String {
    let output = command(dir)
        .arg("--version")
        .output()
        .expect("coinmc starts");
    let text = String::from_utf8(output.stdout).expect("plain text");
    let build = text.trim_end().strip_prefix("coinmc ");
    build
        .expect("the name of the program comes first")
        .to_owned()
}

#[test]
fn the_version_names_the_commit() {
    let dir = tempfile::tempdir().expect("a temporary directory");
    let build = build(dir.path());
    let version = env!("CARGO_PKG_VERSION");
    let git = Command::new("git")
        .args(["rev-parse", "--short=7", "HEAD"])
        .current_dir(root())
        .output();
    let commit = git.ok().filter(|output| output.status.success());
    let Some(commit) = commit.and_then(|output| String::from_utf8(output.stdout).ok()) else {
        // no git here: an archive
        assert!(build.starts_with(version), "{build}");
        return;
    };
    assert!(
        build.starts_with(&format!("{version} ({}", commit.trim_end())),
        "{build} is not {commit}"
    );
}

#[test]
fn a_run_directory_remembers_the_build() {
    let dir = tempfile::tempdir().expect("a temporary directory");
    let config = "coin.ratio = 1.0\nlaunch.preset = 'robot'\nengine.analytic.rule = 'arc'\n";
    fs::write(dir.path().join("toss.toml"), config).expect("the config can be written");
    let status = command(dir.path())
        .args(["run", "toss.toml", "--out", "run", "--quiet"])
        .output()
        .expect("coinmc starts")
        .status;
    assert!(status.success());
    let manifest = fs::read_to_string(dir.path().join("run/manifest.json")).expect("a manifest");
    let manifest: serde_json::Value = serde_json::from_str(&manifest).expect("JSON");
    assert_eq!(manifest["builds"], serde_json::json!([build(dir.path())]));
}

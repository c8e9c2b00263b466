//! Finds the commit that is built. See src/lib.rs.

use std::path::Path;
use std::process::Command;
use std::{env, fs};

/// What programs are compiled from, as seen from this crate: edits there make a commit dirty.
const SOURCES: [&str; 3] = ["../../Cargo.lock", "../../Cargo.toml", "../../python/src"];
/// The same in every crate of the workspace.
const IN_CRATES: [&str; 3] = ["Cargo.toml", "build.rs", "src"];
/// Digits of a commit.
const DIGITS: usize = 7;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-env-changed=COINMC_COMMIT");
    let version = env!("CARGO_PKG_VERSION");
    let commit = given().or_else(published).or_else(from_git);
    let build = commit.map_or(version.to_owned(), |commit| format!("{version} ({commit})"));
    println!("cargo::rustc-env=COINMC_BUILD={build}");
}

/// What the environment says.
fn given() -> Option<String> {
    env::var("COINMC_COMMIT")
        .ok()
        .filter(|commit| !commit.is_empty())
}

/// What cargo wrote down when it packaged this crate.
fn published() -> Option<String> {
    let text = fs::read_to_string(".cargo_vcs_info.json").ok()?;
    let after = text.split_once("\"sha1\"")?.1;
    let commit = after.split('"').nth(1)?.get(..DIGITS)?;
    let dirty = if text.contains("\"dirty\": true") {
        "-dirty"
    } else {
        ""
    };
    Some(format!("{commit}{dirty}"))
}

/// What git says, if it is these sources that it knows. A new commit, or an edited source, asks it
/// again.
fn from_git() -> Option<String> {
    git(&["ls-files", "--error-unmatch", "build.rs"])?;
    let sources = sources();
    watch_commits();
    for source in &sources {
        println!("cargo::rerun-if-changed={source}");
    }
    let commit = git(&["rev-parse", &format!("--short={DIGITS}"), "HEAD"])?;
    let date = git(&["log", "-1", "--format=%cs"])?;
    let mut status = vec!["status", "--porcelain", "--"];
    status.extend(sources.iter().map(String::as_str));
    let dirty = if git(&status)?.is_empty() {
        ""
    } else {
        "-dirty"
    };
    Some(format!("{commit}{dirty} {date}"))
}

/// All sources that are there: cargo would run this at every build for one that is not.
fn sources() -> Vec<String> {
    let crates = fs::read_dir("..").into_iter().flatten().flatten();
    let in_crates = crates.flat_map(|entry| {
        let name = entry.file_name().to_string_lossy().into_owned();
        IN_CRATES.map(|part| format!("../{name}/{part}"))
    });
    let mut sources: Vec<String> = SOURCES
        .map(str::to_owned)
        .into_iter()
        .chain(in_crates)
        .collect();
    sources.retain(|source| Path::new(source).exists());
    sources.sort();
    sources
}

/// Git changes one of these files whenever another commit is checked out.
fn watch_commits() {
    let branch = git(&["symbolic-ref", "--quiet", "HEAD"]);
    for name in ["HEAD", "logs/HEAD", "packed-refs"]
        .into_iter()
        .chain(branch.as_deref())
    {
        if let Some(path) = git(&["rev-parse", "--git-path", name])
            && Path::new(&path).exists()
        {
            println!("cargo::rerun-if-changed={path}");
        }
    }
}

/// What git prints; `None` if it fails or is not there.
fn git(arguments: &[&str]) -> Option<String> {
    // asking must not refresh the index of somebody who works with git meanwhile
    let output = Command::new("git")
        .args(arguments)
        .env("GIT_OPTIONAL_LOCKS", "0")
        .output()
        .ok()?;
    let text = output.status.success().then_some(output.stdout)?;
    Some(String::from_utf8(text).ok()?.trim_end().to_owned())
}

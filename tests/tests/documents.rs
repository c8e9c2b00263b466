//! What README and docs show is what the program does.

use coinmc_tests::{Shown, blocks, command, copy, replay, root};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Every Markdown file of docs/, and those at the root.
fn documents() -> Vec<PathBuf> {
    let mut documents = markdown(root());
    let mut folders = vec![root().join("docs")];
    while let Some(folder) = folders.pop() {
        documents.extend(markdown(&folder));
        folders.extend(entries(&folder).into_iter().filter(|path| path.is_dir()));
    }
    documents.sort();
    documents
}

/// The Markdown files of one folder.
fn markdown(folder: &Path) -> Vec<PathBuf> {
    let is_markdown = |path: &PathBuf| path.extension().is_some_and(|extension| extension == "md");
    entries(folder).into_iter().filter(is_markdown).collect()
}

fn entries(folder: &Path) -> Vec<PathBuf> {
    fs::read_dir(folder)
        .expect("a folder of the repository")
        .map(|entry| entry.expect("a directory entry").path())
        .collect()
}

/// Two documents at a time: many commands use one core.
#[test]
fn commands_print_what_is_shown() {
    let left = Mutex::new(documents());
    let next = || left.lock().unwrap_or_else(PoisonError::into_inner).pop();
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                while let Some(document) = next() {
                    shows_what_commands_print(&document);
                }
            });
        }
    });
}

fn shows_what_commands_print(document: &Path) {
    let dir = tempfile::tempdir().expect("a temporary directory");
    copy(&root().join("examples"), &dir.path().join("examples"));
    replay(document, dir.path(), Shown::EverythingOrNothing, |block| {
        let first = block.lines.first().map_or("", String::as_str);
        first.starts_with("$ coinmc ") || first.starts_with("$ cargo run --release -- ")
    });
}

#[test]
fn configs_are_valid() {
    let dir = tempfile::tempdir().expect("a temporary directory");
    for document in documents() {
        let text = fs::read_to_string(&document).expect("the document can be read");
        let configs = blocks(&text).into_iter().filter(|block| {
            block.info == "toml" && block.lines.iter().any(|line| line.trim_start() == "[coin]")
        });
        for config in configs {
            let path = dir.path().join("config.toml");
            fs::write(&path, config.lines.join("\n")).expect("a config");
            let output = command(dir.path())
                .arg("check")
                .arg(&path)
                .output()
                .expect("it starts");
            assert!(
                output.status.success(),
                "{}, line {}:\n{}",
                document.display(),
                config.first_line,
                String::from_utf8_lossy(&output.stderr)
            );
        }
    }
}

#[test]
fn examples_are_valid() {
    let examples = fs::read_dir(root().join("examples")).into_iter().flatten();
    for entry in examples {
        let path = entry.expect("a directory entry").path();
        if path
            .extension()
            .is_some_and(|extension| extension == "toml")
        {
            let output = command(root())
                .arg("check")
                .arg(&path)
                .output()
                .expect("it starts");
            let stderr = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{}:\n{stderr}", path.display());
        }
    }
}

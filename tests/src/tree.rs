//! Directories as values.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// Says who made a run, and in what time: not the same when it is made again.
const PROVENANCE: &str = "provenance.jsonl";

/// Every file below a directory with its bytes, by relative path, but for the record of who made a run.
///
/// # Panics
/// If something cannot be read.
pub fn snapshot(dir: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut files = BTreeMap::new();
    let mut open = vec![dir.to_owned()];
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(&folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display())) {
            let path = entry.expect("a directory entry").path();
            if path.is_dir() {
                open.push(path);
            } else if !path.ends_with(PROVENANCE) {
                let bytes = fs::read(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
                let name = path
                    .strip_prefix(dir)
                    .expect("below the directory")
                    .to_owned();
                files.insert(name, bytes);
            }
        }
    }
    files
}

/// Copies every file below `from` to `to`; a `from` that does not exist is empty.
///
/// # Panics
/// If something cannot be read or written.
pub fn copy(from: &Path, to: &Path) {
    if !from.exists() {
        return;
    }
    for (name, bytes) in snapshot(from) {
        let path = to.join(name);
        fs::create_dir_all(path.parent().expect("a file lies in a folder")).expect("a folder");
        fs::write(path, bytes).expect("a copy");
    }
}

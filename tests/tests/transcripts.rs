//! Every verb and every class of error, as the transcripts show them.

use coinmc_tests::{Shown, copy, replay, root};
use std::fs;

#[test]
fn the_program_prints_what_the_transcripts_show() {
    let folder = root().join("tests/transcripts");
    let mut documents: Vec<_> = fs::read_dir(&folder)
        .expect("the transcripts are there")
        .map(|entry| entry.expect("a directory entry").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "md"))
        .collect();
    documents.sort();
    assert!(
        documents.len() >= 5,
        "transcripts are missing: {documents:?}"
    );
    for document in documents {
        let dir = tempfile::tempdir().expect("a temporary directory");
        // Files a transcript begins with lie in a folder of its name.
        copy(&document.with_extension(""), dir.path());
        copy(&folder.join("shared"), dir.path());
        replay(&document, dir.path(), Shown::Everything, |_| true);
    }
}

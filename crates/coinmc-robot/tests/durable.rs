//! On a real disk: a journal's lines, its name, and whole files outlast a loss of power. (What happens on a
//! disk that fails: `failing_disk.rs`.)
#![cfg(target_os = "linux")]

use coinmc_robot::journal::{Entry, Header, Journal};
use coinmc_robot::{Setting, replace_file};
use coinmc_testkit::durable::{PLACE, Promise};
use std::fs::OpenOptions;
use std::io::Write;
use std::path::Path;

fn announced(id: u32) -> Entry {
    let setting = Setting::new(3200, 9000).unwrap();
    Entry::Announced {
        id,
        setting,
        at_ms: 7,
    }
}

/// Not a test of its own: what the next test watches.
#[test]
fn child_that_is_watched() {
    let Some(place) = std::env::var_os(PLACE) else {
        return;
    };
    let place = Path::new(&place);
    let path = place.join("journal.txt");
    let header = Header {
        plan_hash: "5d41402abc4b2a76b9719d911017c592".to_owned(),
        throws: 100,
        experiment: 77,
    };
    if path.exists() {
        let (mut journal, torn) = Journal::open(&path, &header).unwrap();
        assert_eq!(torn, 4);
        journal.append(&Entry::Done { id: 1 }).unwrap_err();
    } else {
        let mut journal = Journal::create(&path, &header).unwrap();
        journal.append(&announced(1)).unwrap();
        let reason = coinmc_robot::journal::VoidReason::Lost;
        journal.append(&Entry::Void { id: 1, reason }).unwrap();
        // names of other files are made safe by those who write them together
        replace_file(&place.join("other.csv"), |file| file.write_all(b"whole")).unwrap();
    }
}

#[test]
fn a_loss_of_power_takes_no_line_of_a_journal() {
    let dir = tempfile::tempdir().unwrap();
    let promise = Promise {
        root: dir.path(),
        by_the_line: &["journal.txt"],
        expendable: &[],
    };
    let watch = || promise.broken_by("child_that_is_watched");
    let Some(broken) = watch() else {
        return;
    };
    let name = format!("{}: its name", dir.path().join("other.csv").display());
    assert_eq!(broken, [name]);
    // one that was killed within a line
    let path = dir.path().join("journal.txt");
    let mut file = OpenOptions::new().append(true).open(&path).unwrap();
    file.write_all(b"torn").unwrap();
    drop(file);
    assert_eq!(watch().unwrap(), [""; 0]);
}

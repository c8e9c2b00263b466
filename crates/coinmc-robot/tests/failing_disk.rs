//! The journal on a disk that fails at every call in every way: what was appended is never lost, what
//! is read outlasts a loss of power, and nothing else is in it.

mod disk;

use coinmc_robot::journal::{
    Digest, Entry, Header, History, Journal, JournalError, Measured, Reading, RobotName, VoidReason,
};
use coinmc_robot::{Face, Setting};
use disk::{Disk, Failure};
use std::path::Path;

fn header() -> Header {
    Header {
        plan_hash: "abc".to_owned(),
        throws: 9,
        experiment: 77,
    }
}

fn entries() -> Vec<Entry> {
    let setting = Setting::new(3200, 9000).unwrap();
    let reading = Reading {
        face: Face::Side,
        measured: Measured {
            spin_mrev_s: 3198,
            angle_cdeg: 9003,
        },
        boot: 4,
        image: "000001-1.png".parse().unwrap(),
        digest: Some(Digest(0x5f)),
    };
    vec![
        Entry::Session {
            robot: RobotName {
                uid: 7,
                firmware: [2, 0, 13],
            },
            boot: 4,
            program: "0.1.0".to_owned(),
            at_ms: 1,
        },
        Entry::Announced {
            id: 1,
            setting,
            at_ms: 2,
        },
        Entry::Read {
            id: 1,
            reading,
            at_ms: 3,
        },
        Entry::Done { id: 1 },
        Entry::Announced {
            id: 2,
            setting,
            at_ms: 4,
        },
        Entry::Void {
            id: 2,
            reason: VoidReason::Unread,
        },
    ]
}

/// What the journal says after each number of entries.
fn histories() -> Vec<History> {
    let mut all = vec![History::default()];
    for entry in entries() {
        let mut next = all[all.len() - 1].clone();
        next.add(&entry).unwrap();
        all.push(next);
    }
    all
}

/// How many entries are in it, by what it says.
fn length(journal: &Journal, histories: &[History]) -> usize {
    let length = histories.iter().position(|of| of == journal.history());
    length.expect("a beginning of what was appended")
}

/// One process: opens the journal and appends what is missing, until a call fails. `safe` entries were
/// appended before; how many are now.
fn process(disk: &Disk, failures: &[(u32, Failure)], safe: usize, histories: &[History]) -> usize {
    let path = Path::new("journal.txt");
    let Ok((mut journal, _)) = Journal::open_on(Box::new(disk.open(failures)), path, &header())
    else {
        return safe;
    };
    let mut length = length(&journal, histories);
    assert!(
        length == safe || length == safe + 1,
        "{length} entries of {safe}"
    );
    // what was read is acted upon
    let entries = entries();
    while let Some(entry) = entries.get(length)
        && journal.append(entry).is_ok()
    {
        length += 1;
    }
    length
}

#[derive(Debug, Clone, Copy)]
enum After {
    Restart,
    /// The power fails, and this many bytes of each write without a sync have reached the disk.
    NoPower(usize),
}

#[test]
fn no_error_of_the_disk_loses_an_entry_or_shows_one_that_power_can_take_away() {
    use Failure::{Error, Full, Interrupted, Kill, Short};
    let histories = histories();
    let undisturbed = Disk::default();
    assert_eq!(process(&undisturbed, &[], 0, &histories), 6);
    let mut injected = 0;
    for call in 1..28 {
        for first in [Error, Full, Short, Interrupted, Kill] {
            for then in [None, Some(Error), Some(Full), Some(Kill)] {
                for after in [
                    After::Restart,
                    After::NoPower(0),
                    After::NoPower(9),
                    After::NoPower(99),
                ] {
                    let disk = Disk::default();
                    let mut failures = vec![(call, first)];
                    failures.extend(then.map(|failure| (call + 1, failure)));
                    let mut safe = process(&disk, &failures, 0, &histories);
                    if let After::NoPower(part) = after {
                        disk.lose_power(part);
                    }
                    // reads what is there, and ends at its first entry
                    safe = process(&disk, &[(7, Kill)], safe, &histories);
                    disk.lose_power(0);
                    assert_eq!(process(&disk, &[], safe, &histories), 6);
                    assert_eq!(disk.content(), undisturbed.content());
                    injected += disk.injected();
                }
            }
        }
    }
    assert!(injected > 3_000, "{injected}");
}

/// The entry whose line failed is not in the journal, and no shorter one is written over the beginning of what
/// may be left of it.
#[test]
fn after_a_line_that_failed_nothing_remains_and_nothing_follows() {
    let path = Path::new("journal.txt");
    let [begun, announced, read, ..] = &entries()[..] else {
        unreachable!()
    };
    let reason = VoidReason::Lost;
    let shorter = Entry::Void { id: 1, reason };
    let mut tried = 0;
    for call in 1..20 {
        for cut_fails in [false, true] {
            let disk = Disk::default();
            let (mut journal, _) =
                Journal::open_on(Box::new(disk.open(&[])), path, &header()).unwrap();
            journal.append(begun).unwrap();
            journal.append(announced).unwrap();
            let history = journal.history().clone();
            let mut failures = vec![(call, Failure::Error)];
            failures.extend(cut_fails.then_some((call + 1, Failure::Error)));
            let opened = Journal::open_on(Box::new(disk.open(&failures)), path, &header());
            let Ok((mut journal, _)) = opened else {
                continue;
            };
            let before = disk.content();
            if journal.append(read).is_ok() {
                continue;
            }
            tried += 1;
            assert!(cut_fails || disk.content() == before, "{call}");
            journal.append(&shorter).unwrap_err();
            assert_eq!(journal.history(), &history);
            let again = Journal::open_on(Box::new(disk.open(&[])), path, &header());
            let (journal, _) = again.expect("the next process reads it");
            assert!(cut_fails || journal.history() == &history, "{call}");
        }
    }
    // a seek, a write and a sync, without and with a cut that fails
    assert_eq!(tried, 6);
}

/// A person must know that space is what is missing, and that nothing is lost.
#[test]
fn a_full_disk_is_not_any_error() {
    let path = Path::new("journal.txt");
    let mut full = 0;
    for call in 1..28 {
        for failure in [Failure::Full, Failure::Error] {
            let disk = Disk::default();
            let (mut journal, _) =
                Journal::open_on(Box::new(disk.open(&[])), path, &header()).unwrap();
            journal.append(&entries()[0]).unwrap();
            let opened = Journal::open_on(Box::new(disk.open(&[(call, failure)])), path, &header());
            let Ok((mut journal, _)) = opened else {
                continue;
            };
            let Err(error) = journal.append(&entries()[1]) else {
                continue;
            };
            let is_full = matches!(error, JournalError::OutOfSpace { .. });
            assert_eq!(is_full, failure == Failure::Full, "{call}: {error}");
            assert!(!is_full || error.to_string().contains("Nothing is lost"));
            full += u32::from(is_full);
        }
    }
    // a seek, a write and a sync
    assert_eq!(full, 3);
}

//! The journal's file: incomplete, damaged, of another experiment, in use, on a full disk.

use coinmc_robot::journal::{
    Damage, Digest, Entry, Header, History, Journal, JournalError, LineChecksum, Measured, Reading,
    Resolution, RobotName, VoidReason, parse,
};
use coinmc_robot::{Face, Setting};
use proptest::prelude::*;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

fn header() -> Header {
    Header {
        plan_hash: "5d41402abc4b2a76b9719d911017c592".to_owned(),
        throws: 100,
        experiment: 77,
    }
}

fn announced(id: u32) -> Entry {
    let setting = Setting::new(3200, 9000).unwrap();
    let at_ms = 1_795_281_733_123;
    Entry::Announced { id, setting, at_ms }
}

fn read(id: u32) -> Entry {
    Entry::Read {
        id,
        reading: Reading {
            face: Face::Side,
            measured: Measured {
                spin_mrev_s: 3198,
                angle_cdeg: 18_003,
            },
            boot: 4,
            image: "000001-1.png".parse().unwrap(),
            digest: Some(Digest(0x5f)),
        },
        at_ms: 1_795_281_741_008,
    }
}

fn session() -> Entry {
    Entry::Session {
        robot: RobotName {
            uid: 0x636f_696e_2d73_696d,
            firmware: [2, 0, 13],
        },
        boot: 4,
        program: "0.1.0".to_owned(),
        at_ms: 1_795_281_733_003,
    }
}

/// A journal of two throws: one done, one void.
fn entries() -> [Entry; 6] {
    let reason = VoidReason::Fault(103);
    [
        session(),
        announced(1),
        read(1),
        Entry::Done { id: 1 },
        announced(2),
        Entry::Void { id: 2, reason },
    ]
}

fn written(dir: &TempDir) -> PathBuf {
    let path = dir.path().join("journal.txt");
    let mut journal = Journal::create(&path, &header()).unwrap();
    for entry in entries() {
        journal.append(&entry).unwrap();
    }
    path
}

fn damage(path: &Path) -> Damage {
    match Journal::open(path, &header()) {
        Err(JournalError::Damaged { damage, .. }) => damage,
        other => panic!("{other:?}"),
    }
}

#[test]
fn the_journal_reads_back_and_has_the_documented_format() {
    let dir = tempfile::tempdir().unwrap();
    let path = written(&dir);
    let text = fs::read_to_string(&path).unwrap();
    let bodies: Vec<&str> = text
        .lines()
        .map(|line| line.rsplit_once(' ').unwrap().0)
        .collect();
    assert_eq!(
        bodies,
        [
            "coinmc-robot-journal 2 5d41402abc4b2a76b9719d911017c592 100 77",
            "S 636f696e2d73696d 2.0.13 4 0.1.0 1795281733003",
            "I 1 3200 9000 1795281733123",
            "R 1 side 3198 18003 4 000001-1.png 000000000000005f 1795281741008",
            "D 1",
            "I 2 3200 9000 1795281733123",
            "V 2 fault-103",
        ]
    );
    // the checksum is the CRC-32 of all bodies so far, concatenated
    let checksum = format!("{:08x}", crc32fast::hash(bodies[..2].concat().as_bytes()));
    assert!(text.lines().nth(1).unwrap().ends_with(&checksum));
    let (journal, torn) = Journal::open(&path, &header()).unwrap();
    assert_eq!(torn, 0);
    let throws = journal.history().throws();
    assert_eq!(throws[0].resolution, Some(Resolution::Done));
    assert_eq!(
        throws[1].resolution,
        Some(Resolution::Void(VoidReason::Fault(103)))
    );
}

#[test]
fn an_incomplete_last_line_is_removed() {
    let dir = tempfile::tempdir().unwrap();
    let path = written(&dir);
    let whole = fs::read(&path).unwrap();
    let last = whole[..whole.len() - 1]
        .iter()
        .rposition(|b| *b == b'\n')
        .unwrap()
        + 1;
    for length in last..whole.len() {
        fs::write(&path, &whole[..length]).unwrap();
        let (mut journal, torn) = Journal::open(&path, &header()).unwrap();
        assert_eq!(torn, length - last);
        let reason = VoidReason::Fault(103);
        journal.append(&Entry::Void { id: 2, reason }).unwrap();
        drop(journal);
        assert_eq!(fs::read(&path).unwrap(), whole, "torn at {length}");
    }
    // file systems can fill a lost block with zeros
    fs::write(&path, [&whole[..last], &[0; 4096]].concat()).unwrap();
    let (mut journal, torn) = Journal::open(&path, &header()).unwrap();
    assert_eq!((torn, fs::read(&path).unwrap().len()), (4096, last));
    // nothing of a tail that is longer than the next line shows behind it
    let reason = VoidReason::Fault(103);
    journal.append(&Entry::Void { id: 2, reason }).unwrap();
    drop(journal);
    assert_eq!(fs::read(&path).unwrap(), whole);
    // without a first line nothing was thrown
    fs::write(&path, &whole[..30]).unwrap();
    assert_eq!(
        Journal::open(&path, &header()).unwrap().0.history(),
        &History::default()
    );
}

#[test]
fn damage_before_the_last_line_is_rejected_with_its_line_and_a_remedy() {
    let dir = tempfile::tempdir().unwrap();
    let path = written(&dir);
    let text = fs::read_to_string(&path).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    let write = |lines: &[&str]| fs::write(&path, lines.join("\n") + "\n").unwrap();

    let flipped = lines[3].replace("side", "tide");
    write(&[
        lines[0], lines[1], lines[2], &flipped, lines[4], lines[5], lines[6],
    ]);
    assert_eq!(damage(&path), Damage::Line(4));
    let message = Journal::open(&path, &header()).unwrap_err().to_string();
    assert!(
        message.contains("line 4") && message.contains("head -n 3"),
        "{message}"
    );
    // a missing, repeated or swapped line
    write(&[lines[0], lines[1], lines[3], lines[4]]);
    assert_eq!(damage(&path), Damage::Line(3));
    write(&[lines[0], lines[1], lines[1], lines[2]]);
    assert_eq!(damage(&path), Damage::Line(3));
    fs::write(&path, "something else\n").unwrap();
    assert_eq!(damage(&path), Damage::NotAJournal);
    let message = Journal::open(&path, &header()).unwrap_err().to_string();
    assert!(message.ends_with("Move the directory away or give another one with --out"));
    fs::write(&path, "coinmc-robot-journal 3 x 1 00000000\n").unwrap();
    assert_eq!(damage(&path), Damage::Newer(3));
    let message = Journal::open(&path, &header()).unwrap_err().to_string();
    assert!(
        message.ends_with("use the program that wrote it"),
        "{message}"
    );
    let nothing_was_changed = fs::read_to_string(&path).unwrap();
    assert!(nothing_was_changed.starts_with("coinmc-robot-journal 3"));
}

/// There is no copy of part of a journal whose first line is damaged.
#[test]
fn damage_of_the_first_line_has_another_remedy_than_that_of_the_second() {
    let message = |line| {
        let path = PathBuf::from("journal.txt");
        let damage = Damage::Line(line);
        JournalError::Damaged { path, damage }.to_string()
    };
    assert!(message(1).ends_with("Move the directory away or give another one with --out"));
    assert!(message(2).contains("`head -n 1 journal.txt`"));
}

#[test]
fn contradictory_lines_are_rejected() {
    let (mut text, mut checksum) = LineChecksum::header(&header());
    for body in ["I 1 0 0 5", "D 1"] {
        let (line, next) = checksum.line(body);
        text.push_str(&line);
        checksum = next;
    }
    let error = parse(text.as_bytes()).unwrap_err();
    assert!(matches!(error, Damage::Order { line: 3, .. }), "{error}");
}

/// As the first release wrote them: without robots, programs and digests.
#[test]
fn a_journal_of_format_1_is_read_and_continued() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("journal.txt");
    let (mut text, mut checksum) =
        LineChecksum::default().line("coinmc-robot-journal 1 5d41402abc4b2a76b9719d911017c592 100");
    for body in [
        "I 1 3200 9000 1795281733123",
        "R 1 side 3198 18003 4 000001-1.png 1795281741008",
        "D 1",
    ] {
        let (line, next) = checksum.line(body);
        text.push_str(&line);
        checksum = next;
    }
    fs::write(&path, &text).unwrap();
    let (mut journal, _) = Journal::open(&path, &header()).unwrap();
    let throws = journal.history().throws();
    assert_eq!(throws[0].resolution, Some(Resolution::Done));
    assert_eq!(throws[0].reading.as_ref().unwrap().0.digest, None);
    // its robot is not known, so that it has to be told the experiment's number first
    assert!(!journal.history().is_claimed());
    let number = journal.header().experiment;
    assert_ne!(number, 0);
    for entry in [session(), announced(2)] {
        journal.append(&entry).unwrap();
    }
    assert!(journal.history().is_claimed());
    drop(journal);
    let (again, _) = Journal::open(&path, &header()).unwrap();
    assert_eq!(again.history().throws().len(), 2);
    assert_eq!(again.header().experiment, number);
}

#[test]
fn a_link_or_a_pipe_is_not_opened_as_a_journal() {
    let dir = tempfile::tempdir().unwrap();
    let path = written(&dir);
    let link = dir.path().join("link.txt");
    std::os::unix::fs::symlink(&path, &link).unwrap();
    assert!(matches!(
        Journal::open(&link, &header()),
        Err(JournalError::Io { .. })
    ));
    let pipe = dir.path().join("pipe");
    let status = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(status.unwrap().success());
    assert!(Journal::read(&pipe).is_err() && Journal::open(&pipe, &header()).is_err());
}

#[test]
fn a_journal_of_another_experiment_or_in_use_is_rejected() {
    let dir = tempfile::tempdir().unwrap();
    let path = written(&dir);
    let other = Header {
        throws: 7,
        ..header()
    };
    let error = Journal::open(&path, &other).unwrap_err();
    assert!(matches!(error, JournalError::OtherExperiment { .. }));
    assert!(error.to_string().contains("--out"), "{error}");
    // eight characters of a hash tell plans apart
    let plans = format!(
        "(plan {0}…, {1} throws; this one: plan {0}…, 7 throws)",
        &header().plan_hash[..8],
        header().throws
    );
    assert!(error.to_string().contains(&plans), "{error}");
    assert!(!Journal::is_in_use(&path));
    let held = Journal::open(&path, &header()).unwrap();
    assert!(Journal::is_in_use(&path));
    let error = Journal::open(&path, &header()).unwrap_err();
    assert!(matches!(error, JournalError::Locked { .. }), "{error}");
    // reading needs no lock
    assert_eq!(Journal::read(&path).unwrap().1.throws().len(), 2);
    drop(held);
    assert!(!Journal::is_in_use(&path) && !Journal::is_in_use(&dir.path().join("none")));
    assert!(matches!(
        Journal::create(&path, &header()),
        Err(JournalError::Io { .. })
    ));
}

#[test]
fn entries_out_of_order_change_nothing() {
    let dir = tempfile::tempdir().unwrap();
    let path = written(&dir);
    let before = fs::read(&path).unwrap();
    let (mut journal, _) = Journal::open(&path, &header()).unwrap();
    for wrong in [announced(2), announced(4), read(2), Entry::Done { id: 2 }] {
        assert!(
            matches!(journal.append(&wrong), Err(JournalError::Order { .. })),
            "{wrong}"
        );
    }
    assert_eq!(fs::read(&path).unwrap(), before);
    journal.append(&Entry::Adopted { counter: 40 }).unwrap();
    // a robot that is behind is taken over without counting back
    journal.append(&Entry::Adopted { counter: 2 }).unwrap();
    journal.append(&announced(41)).unwrap();
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, ..ProptestConfig::default() })]

    /// Any damage is rejected, or removes at most the last line.
    #[test]
    fn no_damage_changes_the_throws(
        place in any::<prop::sample::Index>(),
        flip in 1..=u8::MAX,
        cut in any::<bool>(),
    ) {
        let (mut text, mut checksum) = LineChecksum::header(&header());
        let mut histories = vec![History::default()];
        for entry in entries() {
            let (line, next) = checksum.line(&entry.to_string());
            text.push_str(&line);
            checksum = next;
            let mut history = histories[histories.len() - 1].clone();
            history.add(&entry).unwrap();
            histories.push(history);
        }
        let mut bytes = text.into_bytes();
        let place = place.index(bytes.len());
        if cut { bytes.truncate(place) } else { bytes[place] ^= flip }
        if let Ok(parsed) = parse(&bytes) {
            prop_assert!(histories.contains(&parsed.history));
            prop_assert!(cut || parsed.history == histories[entries().len() - 1]);
        }
    }

    #[test]
    fn foreign_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..600)) {
        let _ = parse(&bytes);
    }
}

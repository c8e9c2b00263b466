//! A validation that was stopped and went on finds what one finds that was not, with any number of threads.

use coinmc_questions::Workers;
use coinmc_validate::{Options, Size, ValidateError, document, validate};
use serde_json::Value;
use std::num::NonZeroUsize;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Validates until so many tosses are made.
fn found(
    only: &[&str],
    out: Option<&Path>,
    threads: usize,
    most: u64,
) -> Result<Value, ValidateError> {
    let cancel = AtomicBool::new(false);
    let made = AtomicU64::new(0);
    let workers = Workers {
        threads: NonZeroUsize::new(threads),
        cancel: &cancel,
        made: &|tosses| {
            if made.fetch_add(tosses, Ordering::Relaxed) + tosses >= most {
                cancel.store(true, Ordering::Relaxed);
            }
        },
    };
    let only: Vec<String> = only.iter().map(|name| (*name).to_owned()).collect();
    let options = Options {
        size: Size::Quick,
        only: &only,
        seed: 1,
        out,
        build: "test",
    };
    Ok(document(&validate(&options, &workers)?))
}

/// Claims in the plane: quick.
const CLAIMS: [&str; 2] = ["stopping-rule", "arc-shift"];

#[test]
fn a_stopped_validation_goes_on() {
    let whole = found(&CLAIMS, None, 2, u64::MAX).expect("it ends");
    assert_eq!(whole["claims"][0]["verdict"], "holds");
    assert_eq!(whole["claims"][1]["verdict"], "holds only where");
    let dir = tempfile::tempdir().expect("a directory");
    let runs = || {
        std::fs::read_dir(dir.path().join("claims"))
            .expect("runs")
            .count()
    };
    let stopped = found(&CLAIMS, Some(dir.path()), 1, 30_000);
    assert!(
        matches!(stopped, Err(ValidateError::Stopped)),
        "{stopped:?}"
    );
    assert_eq!(runs(), 3);
    let gone_on = found(&CLAIMS, Some(dir.path()), 2, u64::MAX);
    assert_eq!(gone_on.expect("it goes on"), whole);
    assert_eq!(runs(), 7);
}

/// The draws of a prior, each tossed by whichever thread is free.
#[test]
fn a_prediction_does_not_depend_on_threads() {
    let by = |threads| found(&["gaek-sukhov-flat"], None, threads, u64::MAX).expect("it ends");
    let one = by(1);
    assert_eq!(one["sets"][0]["verdict"], "not rejected");
    assert_eq!(one, by(3));
}

#[test]
fn a_name_that_nothing_has_is_told_before_any_toss() {
    let cancel = AtomicBool::new(false);
    let workers = Workers {
        threads: None,
        cancel: &cancel,
        made: &|_| panic!("a toss"),
    };
    let only = ["mass", "kerich", "zzz"].map(str::to_owned);
    let options = Options {
        size: Size::Full,
        only: &only,
        seed: 1,
        out: None,
        build: "test",
    };
    let error = validate(&options, &workers).expect_err("no such name");
    let text = error.to_string();
    assert!(
        text.contains("`kerich` (did you mean `kerrich`?), `zzz`;"),
        "{text}"
    );
    assert!(text.contains("arc-rule, arc-shift"), "{text}");
}

#[test]
fn the_directory_of_something_else_is_refused_and_stays_as_it_is() {
    let dir = tempfile::tempdir().expect("a directory");
    std::fs::create_dir(dir.path().join("sets")).expect("a place of a validation");
    assert!(found(&CLAIMS[..1], Some(dir.path()), 1, u64::MAX).is_ok());
    std::fs::remove_dir_all(dir.path().join("claims")).expect("its tosses");
    std::fs::write(dir.path().join("manifest.json"), "{}").expect("a file");
    let refused = found(&CLAIMS[..1], Some(dir.path()), 1, u64::MAX).expect_err("another's");
    assert!(refused.to_string().contains("manifest.json"), "{refused}");
    assert!(!dir.path().join("claims").exists());
}

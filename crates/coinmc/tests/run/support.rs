//! Helpers of the tests of runs.
#![allow(dead_code, reason = "each test binary uses its own share")]

use coinmc::plan::Plan;
use coinmc::run::{Options, Part, Progress, ProgressSink, Report, RunError, run};
use std::collections::BTreeMap;
use std::num::NonZeroUsize;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::SeqCst};

/// Two restitutions, three ratios, 40 000 tosses a point: 18 chunks.
pub(crate) const FIXED: &str = "tosses = 40_000";
/// For a run that is cancelled once its first chunk is stored: a second and more, as a busy disk takes a tenth of one.
pub(crate) const LONG: &str = "tosses = 200_000";
/// Up to 8 looks; the flat engine's P(side) is known to ± 0.004 after some 100 000 tosses.
pub(crate) const HALF_WIDTH: &str = "half_width = 0.006\nmax_tosses = 1_000_000";

/// A flat plan with this stop rule.
pub(crate) fn plan(stop: &str) -> Plan {
    plan_of(&format!(
        "[coin]\nratio = [1.0, 1.5, 2.0]\n[surface]\nrestitution = [0.3, 0.6]\n[stop]\n{stop}\n"
    ))
}

/// A flat plan with a coin, a surface and a stop rule of its own.
pub(crate) fn plan_of(tables: &str) -> Plan {
    let text = format!(
        "seed = 7\n[launch]\npreset = \"robot\"\n[engine.flat]\nzeno = 0.05\n{}",
        tables
            .replace("[coin]", "[coin]\nradius_m = 0.01")
            .replace("[surface]", "[surface]\nfriction = 0.3")
    );
    coinmc::config::parse("test", &text, &[]).unwrap_or_else(|problems| panic!("{problems}"))
}

/// A plan of tosses in space: all three kinds of friction, two ratios, 40 000 tosses a point.
pub(crate) fn plan_in_space(law: &str, stop: &str) -> Plan {
    let text = format!(
        "seed = 7\n[coin]\nradius_m = 0.01\nratio = [0.85, 2.0]\n[surface]\nrestitution = 0.5\n\
         friction = 0.3\nrolling_friction_m = 1e-4\npivoting_friction_m = 1e-4\n[launch]\npreset = \"clean\"\n\
         [engine.volumetric]\nlaw = \"{law}\"\n[stop]\n{stop}\n"
    );
    coinmc::config::parse("test", &text, &[]).unwrap_or_else(|problems| panic!("{problems}"))
}

/// Runs the whole plan on two threads without progress.
pub(crate) fn run_whole(plan: &Plan, out: &Path) -> Report {
    run_with(plan, out, Part::WHOLE, 2, &Ear::default()).unwrap()
}

/// Runs a part and cancels it after enough progress.
pub(crate) fn run_with(
    plan: &Plan,
    out: &Path,
    part: Part,
    threads: usize,
    ear: &Ear,
) -> Result<Report, RunError> {
    run_as_build("0.1.0 (test)", plan, out, part, threads, ear)
}

/// [`run_with`] by this build of the program.
pub(crate) fn run_as_build(
    build: &str,
    plan: &Plan,
    out: &Path,
    part: Part,
    threads: usize,
    ear: &Ear,
) -> Result<Report, RunError> {
    let threads = NonZeroUsize::new(threads);
    run(
        plan,
        &Options {
            out,
            build,
            part,
            threads,
            cancel: &ear.cancel,
            sink: ear,
        },
    )
}

/// Records progress and warnings, and cancels at the `cancel_at`-th report.
#[derive(Default)]
pub(crate) struct Ear {
    pub(crate) warnings: Mutex<Vec<String>>,
    pub(crate) progress: Mutex<Vec<Progress>>,
    pub(crate) cancel: AtomicBool,
    pub(crate) cancel_at: Option<usize>,
    heard: AtomicUsize,
}

impl Ear {
    pub(crate) fn that_cancels_at(count: usize) -> Self {
        Self {
            cancel_at: Some(count),
            ..Self::default()
        }
    }

    pub(crate) fn warnings(&self) -> Vec<String> {
        self.warnings.lock().unwrap().clone()
    }
}

impl ProgressSink for Ear {
    fn progress(&self, progress: &Progress) {
        self.progress.lock().unwrap().push(*progress);
        if self.cancel_at == Some(self.heard.fetch_add(1, SeqCst)) {
            self.cancel.store(true, SeqCst);
        }
    }

    fn warning(&self, message: &str) {
        self.warnings.lock().unwrap().push(message.to_owned());
    }
}

/// The texts of the finished chunks of a run directory, in the order of its file.
pub(crate) fn tallies(dir: &Path) -> Vec<String> {
    let Ok(text) = std::fs::read_to_string(dir.join("tallies.txt")) else {
        return vec![];
    };
    let (mut all, mut tally) = (Vec::new(), String::new());
    for line in text.lines() {
        tally.push_str(line);
        tally.push('\n');
        if line.starts_with("crc32 ") {
            all.push(std::mem::take(&mut tally));
        }
    }
    assert_eq!(tally, "", "the file ends with a whole text");
    all
}

/// Puts texts in the place of those of a run directory.
pub(crate) fn put_tallies(dir: &Path, texts: &[String]) {
    std::fs::write(dir.join("tallies.txt"), texts.concat()).unwrap();
}

/// Alters a text and gives it a right checksum again.
pub(crate) fn resealed(text: &str, alter: impl Fn(&str) -> String) -> String {
    let text = alter(text);
    let (body, _) = text.rsplit_once("crc32 ").unwrap();
    format!("{body}crc32 {:08x}\n", crc32fast::hash(body.as_bytes()))
}

/// Says who made a run, and in what time: not the same when it is made again.
const PROVENANCE: &str = "provenance.jsonl";

/// Every file of a directory by its path there, but for the record of who made it.
pub(crate) fn contents(dir: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut all = BTreeMap::new();
    for entry in std::fs::read_dir(dir).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        if name == PROVENANCE {
            continue;
        }
        if path.is_dir() {
            let inner = contents(&path).into_iter();
            all.extend(inner.map(|(below, bytes)| (format!("{name}/{below}"), bytes)));
        } else {
            all.insert(name, std::fs::read(&path).unwrap());
        }
    }
    all
}

/// Whether two directories are the same to the byte; names the first file that differs.
pub(crate) fn assert_same(a: &Path, b: &Path) {
    let (a, b) = (contents(a), contents(b));
    assert_eq!(a.keys().collect::<Vec<_>>(), b.keys().collect::<Vec<_>>());
    for (name, bytes) in &a {
        assert!(*bytes == b[name], "{name} differs");
    }
}

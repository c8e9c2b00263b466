//! Pages, which appear when they are complete and replace no file but those that they may.

use super::new_file::must_end_in;
use super::question::write_file;
use crate::exit::Failure;
use anyhow::{Context, anyhow};
use coinmc_recording::{NewFile, sync_directory};
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

/// What a page may replace.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Replaceable {
    Nothing,
    /// A page that coinmc made.
    AnyPage,
    /// A page of one run alone, whose plan has one of these hashes.
    PageOf(Vec<String>),
}

impl Replaceable {
    /// Refuses a name at which stands what is not to be replaced.
    pub(super) fn check(&self, path: &Path) -> Result<(), Failure> {
        if !stands(path) {
            return Ok(());
        }
        let refused = match self {
            Self::Nothing => "exists already",
            _ if !is_page(path) => "is no page of coinmc and is not replaced",
            Self::PageOf(hashes) if !is_of_one(path, hashes) => {
                "is not a page of this run alone and is not replaced"
            }
            Self::AnyPage | Self::PageOf(_) => return Ok(()),
        };
        Err(Failure::Input(anyhow!(
            "{} {refused}: choose another name, or move it away",
            path.display()
        )))
    }
}

/// A page that appears when it is complete: a new file, or in place of an earlier page.
pub(super) struct Page {
    path: PathBuf,
    file: NewFile,
    /// Where the page is written first, if it replaces one.
    beside: Option<PathBuf>,
    replaceable: Replaceable,
}

impl Page {
    /// Begins a page, in place of what stands there only if that is replaceable.
    pub(super) fn begin(path: &Path, replaceable: Replaceable) -> Result<Self, Failure> {
        replaceable.check(path)?;
        must_end_in(path, "html")?;
        let beside = stands(path).then(|| beside(path));
        Ok(Self {
            file: NewFile::begin(beside.as_deref().unwrap_or(path))?,
            path: path.to_owned(),
            beside,
            replaceable,
        })
    }

    /// Writes the page and gives it its name. What has come to stand there in the meantime is checked again.
    pub(super) fn write(self, text: &str) -> Result<(), Failure> {
        write_file(self.file, text)?;
        let Some(beside) = self.beside else {
            return Ok(());
        };
        let replaced = self.replaceable.check(&self.path).and_then(|()| {
            fs::rename(&beside, &self.path)
                .with_context(|| format!("cannot replace {}", self.path.display()))
                .map_err(Failure::Runtime)?;
            Ok(sync_directory(&self.path)?)
        });
        if replaced.is_err() {
            // a leftover does no harm
            let _ = fs::remove_file(&beside);
        }
        replaced
    }
}

/// Where a page is written that is to replace one: a free name, as a killed process may have left one behind.
fn beside(path: &Path) -> PathBuf {
    let named = |attempt: u32| {
        let mut name = path.file_name().unwrap_or_default().to_owned();
        name.push(format!(".{}-{attempt}.new", std::process::id()));
        path.with_file_name(name)
    };
    let mut attempt = 0;
    while stands(&named(attempt)) {
        attempt += 1;
    }
    named(attempt)
}

/// Whether anything has this name, be it a link to nothing.
fn stands(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok()
}

/// Whether a file begins as the pages of coinmc do.
fn is_page(path: &Path) -> bool {
    let mut start = Vec::new();
    let read = fs::File::open(path).and_then(|file| file.take(2000).read_to_end(&mut start));
    let text = String::from_utf8_lossy(&start);
    read.is_ok() && text.starts_with("<!doctype html>") && text.contains("content=\"coinmc ")
}

/// Whether a page shows one run alone, whose plan has one of these hashes.
fn is_of_one(path: &Path, hashes: &[String]) -> bool {
    let shown = fs::read_to_string(path).map(|page| coinmc_report::plan_hashes(&page));
    matches!(shown.as_deref(), Ok([one]) if hashes.contains(one))
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc::plan::{Plan, StoppedBy};
    use coinmc::results::{Results, Row};
    use coinmc::run::{Report, Status};
    use coinmc_report::{Run, Samples, report};

    fn plan(ratio: u32) -> Plan {
        let config = format!("coin.ratio = {ratio}\nengine.analytic.rule = 'arc'");
        coinmc::config::parse("test", &config, &[]).unwrap()
    }

    fn run_of(ratio: u32) -> Run {
        let plan = plan(ratio);
        let row = Row::new(
            &plan,
            0,
            coinmc_core::Tally::default(),
            StoppedBy::ClosedForm,
        );
        let report_of = Report {
            results: Results::new(&plan, vec![row].into()),
            status: Status::Complete,
            reused_chunks: 0,
            tosses: 0,
            tosses_planned: 0,
        };
        Run::in_memory("a", plan, report_of)
    }

    fn page(ratios: &[u32]) -> String {
        let runs: Vec<Run> = ratios.iter().map(|&ratio| run_of(ratio)).collect();
        report(&runs, None, &Samples::default()).unwrap()
    }

    fn names(dir: &Path) -> Vec<String> {
        let entries = fs::read_dir(dir).unwrap();
        let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        names.collect()
    }

    fn begin(path: &Path, replaceable: Replaceable) -> Page {
        Page::begin(path, replaceable).unwrap_or_else(|refused| panic!("{}", refused.message()))
    }

    #[test]
    fn only_pages_are_replaced_and_only_on_demand() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.html");
        let (first, second) = (page(&[1]), page(&[2]));
        begin(&path, Replaceable::Nothing).write(&first).unwrap();
        assert!(Page::begin(&path, Replaceable::Nothing).is_err());
        begin(&path, Replaceable::AnyPage).write(&second).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), second);
        fs::write(&path, "my notes").unwrap();
        assert!(Page::begin(&path, Replaceable::AnyPage).is_err());
        assert!(Page::begin(&dir.path().join("a.txt"), Replaceable::AnyPage).is_err());
        assert_eq!(names(dir.path()), ["a.html"]);
    }

    #[test]
    fn a_run_replaces_pages_of_that_run_alone() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.html");
        let own = Replaceable::PageOf(vec![plan(1).hash(), plan(2).hash()]);
        assert!(own.check(&path).is_ok());
        for (ratios, is_own) in [
            (&[1][..], true),
            (&[2], true),
            (&[3], false),
            (&[1, 2], false),
        ] {
            fs::write(&path, page(ratios)).unwrap();
            assert_eq!(own.check(&path).is_ok(), is_own, "{ratios:?}");
        }
    }

    #[test]
    fn a_file_that_takes_the_place_while_the_page_is_made_stays() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.html");
        fs::write(&path, page(&[1])).unwrap();
        let begun = begin(&path, Replaceable::AnyPage);
        fs::write(&path, "my notes").unwrap();
        assert!(begun.write(&page(&[2])).is_err());
        assert_eq!(fs::read_to_string(&path).unwrap(), "my notes");
        assert_eq!(names(dir.path()), ["a.html"]);
    }

    #[test]
    fn what_a_killed_process_left_does_not_stop_the_next() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.html");
        fs::write(&path, page(&[1])).unwrap();
        let leftover = beside(&path);
        fs::write(&leftover, "half").unwrap();
        fs::write(dir.path().join("a.html.new"), "half").unwrap();
        begin(&path, Replaceable::AnyPage)
            .write(&page(&[2]))
            .unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), page(&[2]));
    }
}

//! Who tosses for a validation: in memory, or in run directories that a later call goes on with.

use crate::{Size, ValidateError};
use coinmc::config::{self, Override};
use coinmc::plan::Plan;
use coinmc::results::Results;
use coinmc::run::{Count, Options, Part, Status, count, run};
use coinmc_questions::Workers;
use std::num::NonZeroUsize;
use std::path::Path;
use std::sync::atomic::Ordering;

/// A config by its text and what replaces parts of it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Scene {
    /// Its place below the directory of the validation.
    pub(crate) name: String,
    pub(crate) text: String,
    /// As in `--set`, in this order.
    pub(crate) overrides: Vec<String>,
}

impl Scene {
    pub(crate) fn new(name: impl Into<String>, text: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            text: text.into(),
            overrides: vec![],
        }
    }

    /// The same with this under a key.
    pub(crate) fn with(mut self, setting: impl Into<String>) -> Self {
        self.overrides.push(setting.into());
        self
    }

    fn plan(&self, seed: u64, tosses: u64) -> Result<Plan, ValidateError> {
        let fixed = [
            format!("seed={seed}"),
            format!("stop={{ tosses = {tosses} }}"),
        ];
        let settings = self.overrides.iter().chain(&fixed);
        let overrides = settings
            .map(|setting| setting.parse().map_err(ValidateError::Key))
            .collect::<Result<Vec<Override>, _>>()?;
        Ok(config::parse(&self.name, &self.text, &overrides)?)
    }
}

/// Who tosses.
#[derive(Clone, Copy)]
pub(crate) struct Tosser<'a> {
    pub(crate) seed: u64,
    pub(crate) size: Size,
    /// The directory of the validation; nothing is stored without one.
    pub(crate) out: Option<&'a Path>,
    pub(crate) build: &'a str,
    pub(crate) workers: Workers<'a>,
}

impl Tosser<'_> {
    /// `quick` or `full` tosses of each point of a scene, on all threads.
    pub(crate) fn toss(
        &self,
        scene: &Scene,
        quick: u64,
        full: u64,
    ) -> Result<Results, ValidateError> {
        self.toss_on(scene, self.size.of(quick, full), self.workers.threads)
    }

    /// So many tosses of each point of each scene, one scene a thread: for many small ones.
    pub(crate) fn toss_each(
        &self,
        scenes: &[Scene],
        tosses: u64,
    ) -> Result<Vec<Results>, ValidateError> {
        self.workers.each(scenes.len(), &|index| {
            self.toss_on(&scenes[index], tosses, NonZeroUsize::new(1))
        })
    }

    fn toss_on(
        &self,
        scene: &Scene,
        tosses: u64,
        threads: Option<NonZeroUsize>,
    ) -> Result<Results, ValidateError> {
        let cancel = self.workers.cancel;
        if cancel.load(Ordering::Relaxed) {
            return Err(ValidateError::Stopped);
        }
        let plan = scene.plan(self.seed, tosses)?;
        let report = match self.out {
            Some(out) => run(
                &plan,
                &Options {
                    out: &out.join(&scene.name),
                    build: self.build,
                    part: Part::WHOLE,
                    threads,
                    cancel,
                    sink: &(),
                },
            ),
            None => count(
                &plan,
                &Count {
                    threads,
                    cancel,
                    sink: &(),
                },
            ),
        }?;
        if report.status == Status::Interrupted {
            return Err(ValidateError::Stopped);
        }
        (self.workers.made)(report.tosses);
        Ok(report.results)
    }
}

//! What all questions share: the scene they are about, and tosses with progress that can be stopped.

use crate::exit::Failure;
use crate::interrupt;
use crate::output::{Console, Format};
use crate::terminal::progress::Progress;
use anyhow::anyhow;
use clap::Args;
use coinmc::config::{self, Override};
use coinmc_atlas::AtlasError;
#[cfg(feature = "film")]
use coinmc_calibrate::CalibrationError;
use coinmc_questions::scenes::{Assumption, EverydayScene};
use coinmc_questions::{DesignError, QuestionError, Template, Unknown, Workers};
use coinmc_recording::NewFile;
use std::io::Write;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::str::FromStr;
use std::sync::atomic::{AtomicU64, Ordering};

/// Which scene a question is about.
#[derive(Debug, Args)]
pub(super) struct SceneArgs {
    /// The config (TOML) of the scene; its [stop] has no effect
    config: Option<PathBuf>,

    /// Everyday scene, see `coinmc fair --help` [default: table]
    #[arg(long, value_name = "NAME", conflicts_with = "config", value_parser = super::names::scenes())]
    #[arg(hide_possible_values = true)]
    scene: Option<String>,

    /// Replace or add a value of the config, as in `surface.friction=0.2`; repeatable
    #[arg(long = "set", value_name = "KEY=VALUE")]
    overrides: Vec<Override>,
}

impl SceneArgs {
    /// The scene of the config, or the everyday scene of this name; the first of them without either.
    pub(super) fn template(&self) -> Result<(Option<EverydayScene>, Template), Failure> {
        if let Some(path) = &self.config {
            let text = config::read_text(path)?;
            let name = path.display().to_string();
            return Ok((None, Template::new(name, text, &self.overrides)));
        }
        let name = self.scene.as_deref().unwrap_or(EverydayScene::ALL[0].name);
        let scene = EverydayScene::named(name)?;
        Ok((Some(scene), scene.template(&self.overrides)))
    }

    /// What the command line replaces.
    pub(super) fn overrides(&self) -> &[Override] {
        &self.overrides
    }

    /// What an everyday scene assumes and the command line does not say otherwise.
    pub(super) fn assumed(&self, scene: &EverydayScene) -> Vec<Assumption> {
        scene.assumed(&self.overrides)
    }
}

/// How to work on a question, and how to answer it.
#[derive(Debug, Args)]
pub(super) struct AnswerArgs {
    /// Number of threads [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(super) threads: Option<u16>,

    /// How to write the result
    #[arg(long, value_enum, default_value_t = Format::Table)]
    pub(super) format: Format,

    /// Show no progress and no remarks, only warnings and errors
    #[arg(long, short)]
    pub(super) quiet: bool,
}

/// A number of a scene and its range, as in `launch.height_m=0.1..2`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct KeyRange {
    pub(super) key: String,
    pub(super) from: f64,
    pub(super) to: f64,
    /// As it was typed.
    pub(super) text: String,
}

impl KeyRange {
    pub(super) fn unknown(&self) -> Unknown {
        Unknown {
            key: self.key.clone(),
            from: self.from,
            to: self.to,
        }
    }
}

impl FromStr for KeyRange {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parsed = text.split_once('=').and_then(|(key, range)| {
            let (from, to) = range.split_once("..")?;
            Some(Self {
                key: key.trim().to_owned(),
                text: text.to_owned(),
                from: from.trim().parse().ok()?,
                to: to.trim().parse().ok()?,
            })
        });
        parsed.ok_or_else(|| {
            "expected a key and its range, as in `launch.height_m=0.1..2`".to_owned()
        })
    }
}

/// A range and the number of its values behind a colon, as in `launch.height_m=0.1..2:15`.
pub(super) fn range_and_count(text: &str, default: usize) -> Result<(KeyRange, usize), String> {
    let (range, values) = match text.split_once(':') {
        Some((range, count)) => {
            let wrong = |_| "expected the number of values behind the colon".to_owned();
            (range, count.parse().map_err(wrong)?)
        }
        None => (text, default),
    };
    let range = KeyRange {
        text: text.to_owned(),
        ..range.parse()?
    };
    Ok((range, values))
}

/// Why there is no answer.
pub(super) enum Unanswered {
    /// Ctrl-C.
    Stopped,
    Failed(Failure),
}

impl From<QuestionError> for Unanswered {
    fn from(error: QuestionError) -> Self {
        match error {
            QuestionError::Stopped => Self::Stopped,
            error => Self::Failed(error.into()),
        }
    }
}

#[cfg(feature = "film")]
impl From<CalibrationError> for Unanswered {
    fn from(error: CalibrationError) -> Self {
        match error {
            CalibrationError::Question(error) => error.into(),
            error => Self::Failed(error.into()),
        }
    }
}

impl From<AtlasError> for Unanswered {
    fn from(error: AtlasError) -> Self {
        match error {
            AtlasError::Tosses(error) => error.into(),
            error => Self::Failed(error.into()),
        }
    }
}

impl From<DesignError> for Unanswered {
    fn from(error: DesignError) -> Self {
        match error {
            DesignError::Question(error) => error.into(),
            error => Self::Failed(error.into()),
        }
    }
}

/// Asks, with progress on standard error.
pub(super) fn ask<T, E: Into<Unanswered>>(
    console: &Console,
    args: &AnswerArgs,
    question: impl FnOnce(&Workers<'_>) -> Result<T, E>,
) -> Result<T, Failure> {
    let progress = Progress::new(*console.stderr(), args.quiet);
    let told = progress.clone();
    let cancel =
        interrupt::listen(move || told.note("stopping; press Ctrl-C again to stop at once"))?;
    let made = AtomicU64::new(0);
    let answer = question(&Workers {
        threads: args.threads.and_then(|n| NonZeroUsize::new(n.into())),
        cancel,
        made: &|tosses| progress.tossed(made.fetch_add(tosses, Ordering::Relaxed) + tosses),
    });
    progress.finish();
    answer.map_err(|error| match error.into() {
        Unanswered::Stopped => Failure::Interrupted,
        Unanswered::Failed(failure) => failure,
    })
}

/// Writes a new file that was begun.
pub(super) fn write_file(mut file: NewFile, content: impl AsRef<[u8]>) -> Result<(), Failure> {
    let written = file.write_all(content.as_ref());
    written
        .and_then(|()| file.flush())
        .map_err(|error| Failure::Runtime(anyhow!(error)))?;
    file.finish()?;
    Ok(())
}

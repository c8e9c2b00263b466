//! Exit codes, and how failures are reported.

use crate::output::{self, Console, Format};
use crate::terminal::Colors;
use anyhow::anyhow;
use coinmc::config::Diagnostics;
use coinmc::run::RunError;
use coinmc_atlas::AtlasError;
#[cfg(feature = "film")]
use coinmc_calibrate::CalibrationError;
#[cfg(feature = "film")]
use coinmc_film::text as film;
use coinmc_questions::{DesignError, QuestionError};
use coinmc_recording::Error as RecordingError;
use coinmc_trace::TraceError;
use serde_json::{Value, json};

/// Ways to end without a failure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// Everything was done.
    Done,
    /// `max_tosses` came before the targets at some point, or `--max-time` before the end.
    ShortOfTarget,
    /// Ctrl-C or SIGTERM, with what there is so far as the result.
    Interrupted,
}

/// Why the command failed.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The config has these problems.
    Config(Diagnostics),
    /// The files of filmed drops have these problems.
    #[cfg(feature = "film")]
    Film(film::Diagnostics),
    /// An argument, or a directory it names, is wrong.
    Input(anyhow::Error),
    /// A robot needs a person.
    #[cfg(feature = "robot")]
    Halted(anyhow::Error),
    /// The input was right, but reading, writing or computing failed.
    Runtime(anyhow::Error),
    /// Ctrl-C or SIGTERM before there was anything to show.
    Interrupted,
}

/// What a document says of [`Failure::Interrupted`]; people are told as the signal comes.
const NO_ANSWER: &str = "stopped by Ctrl-C or SIGTERM before there was an answer";

/// Exit codes; `arguments.rs` documents them for users.
const DONE: u8 = 0;
const FAILED: u8 = 1;
pub(crate) const BAD_INPUT: u8 = 2;
const SHORT_OF_TARGET: u8 = 3;
#[cfg(feature = "robot")]
const HALTED: u8 = 4;
/// 128 + SIGINT, as shells report it. Also the code of a second Ctrl-C.
pub(crate) const INTERRUPTED: u8 = 130;

impl From<Outcome> for u8 {
    fn from(outcome: Outcome) -> Self {
        match outcome {
            Outcome::Done => DONE,
            Outcome::ShortOfTarget => SHORT_OF_TARGET,
            Outcome::Interrupted => INTERRUPTED,
        }
    }
}

impl From<Diagnostics> for Failure {
    fn from(diagnostics: Diagnostics) -> Self {
        Self::Config(diagnostics)
    }
}

impl From<RunError> for Failure {
    /// A directory that holds something else and parts that do not match are bad input, like a bad config.
    fn from(error: RunError) -> Self {
        match error {
            RunError::Several(errors) => several(errors.into_iter().map(Self::from)),
            RunError::NotARunDirectory { .. }
            | RunError::NoRun { .. }
            | RunError::OtherPlan { .. }
            | RunError::ChangedConfig { .. }
            | RunError::OtherVersion { .. }
            | RunError::OtherPart { .. }
            | RunError::NewerFormat { .. }
            | RunError::OlderFormat { .. }
            | RunError::PartsNeedFixedTosses
            | RunError::NothingToMerge
            | RunError::BadConfig { .. }
            | RunError::MergeIntoPart { .. }
            | RunError::Missing { .. }
            | RunError::Conflict { .. } => Self::Input(error.into()),
            _ => Self::Runtime(error.into()),
        }
    }
}

/// Several failures as one: bad input if every one of them is.
pub(crate) fn several(failures: impl Iterator<Item = Failure>) -> Failure {
    let failures: Vec<Failure> = failures.collect();
    let words: Vec<String> = failures.iter().map(Failure::message).collect();
    let error = anyhow!("{}", words.join("\n"));
    if failures.iter().all(|failure| failure.code() == BAD_INPUT) {
        Failure::Input(error)
    } else {
        Failure::Runtime(error)
    }
}

impl From<QuestionError> for Failure {
    fn from(error: QuestionError) -> Self {
        match error {
            QuestionError::Config(diagnostics) => Self::Config(diagnostics),
            QuestionError::Run(error) => error.into(),
            QuestionError::Several(errors) => several(errors.into_iter().map(Self::from)),
            QuestionError::Thread(_) => Self::Runtime(error.into()),
            _ => Self::Input(error.into()),
        }
    }
}

impl From<AtlasError> for Failure {
    fn from(error: AtlasError) -> Self {
        match error {
            AtlasError::Tosses(error) => error.into(),
            _ => Self::Input(error.into()),
        }
    }
}

impl From<DesignError> for Failure {
    fn from(error: DesignError) -> Self {
        match error {
            DesignError::Question(error) => error.into(),
            DesignError::Mesh(_) => Self::Runtime(error.into()),
            DesignError::Shape(_)
            | DesignError::Mass(_)
            | DesignError::NoSingleRoot
            | DesignError::Loaded => Self::Input(error.into()),
        }
    }
}

#[cfg(feature = "film")]
impl From<CalibrationError> for Failure {
    fn from(error: CalibrationError) -> Self {
        match error {
            CalibrationError::Config(diagnostics) => Self::Config(diagnostics),
            CalibrationError::Question(error) => error.into(),
            CalibrationError::Fit(_) => Self::Runtime(error.into()),
            _ => Self::Input(error.into()),
        }
    }
}

impl From<TraceError> for Failure {
    /// Which tosses exist and can be traced follows from the arguments: always bad input.
    fn from(error: TraceError) -> Self {
        Self::Input(error.into())
    }
}

impl From<RecordingError> for Failure {
    fn from(error: RecordingError) -> Self {
        match error {
            RecordingError::Exists { .. }
            | RecordingError::NotMcap { .. }
            | RecordingError::Io { action: "open", .. } => Self::Input(error.into()),
            _ => Self::Runtime(error.into()),
        }
    }
}

/// An error and its causes, without repetition: many errors quote their cause themselves.
pub(crate) fn words(error: &anyhow::Error) -> String {
    let mut words = error.to_string();
    for cause in error.chain().skip(1) {
        let cause = cause.to_string();
        if !words.contains(&cause) {
            words += &format!(": {cause}");
        }
    }
    words
}

impl Failure {
    /// Reports the failure: as text on standard error, or as JSON on standard output.
    pub(crate) fn report(&self, console: &Console) -> u8 {
        match console.format() {
            // if standard output is closed too, the exit code still reports the failure
            Format::Json => drop(output::print_json(&self.to_json())),
            Format::Table => self.explain(console),
        }
        self.code()
    }

    /// What happened, in one text.
    pub(crate) fn message(&self) -> String {
        match self {
            Self::Config(diagnostics) => diagnostics.render(false),
            #[cfg(feature = "film")]
            Self::Film(diagnostics) => diagnostics.render(false),
            Self::Input(error) | Self::Runtime(error) => words(error),
            #[cfg(feature = "robot")]
            Self::Halted(error) => words(error),
            Self::Interrupted => NO_ANSWER.to_owned(),
        }
    }

    fn code(&self) -> u8 {
        match self {
            Self::Config(_) | Self::Input(_) => BAD_INPUT,
            #[cfg(feature = "film")]
            Self::Film(_) => BAD_INPUT,
            Self::Runtime(_) => FAILED,
            #[cfg(feature = "robot")]
            Self::Halted(_) => HALTED,
            Self::Interrupted => INTERRUPTED,
        }
    }

    fn explain(&self, console: &Console) {
        match self {
            Self::Config(diagnostics) => {
                output::note(&diagnostics.render(console.stderr().color));
                let problems = diagnostics.problems().len();
                output::note(&format!(
                    "\n{problems} problem{} found, nothing was run",
                    if problems == 1 { "" } else { "s" }
                ));
            }
            #[cfg(feature = "film")]
            Self::Film(diagnostics) => {
                output::note(&diagnostics.render(console.stderr().color));
                let problems = diagnostics.problems().len();
                output::note(&format!(
                    "\n{problems} problem{} found, nothing was done",
                    if problems == 1 { "" } else { "s" }
                ));
            }
            #[cfg(feature = "robot")]
            Self::Halted(error) => report_error(error, console),
            Self::Input(error) | Self::Runtime(error) => report_error(error, console),
            Self::Interrupted => {}
        }
    }

    fn to_json(&self) -> Value {
        match self {
            Self::Config(diagnostics) => json!({
                "format_version": output::FORMAT_VERSION,
                "kind": "problems",
                "problems": diagnostics.problems().iter().map(|problem| json!({
                    "file": problem.source,
                    "line": problem.line,
                    "column": problem.column,
                    "message": problem.message,
                    "help": problem.help,
                })).collect::<Vec<_>>(),
            }),
            #[cfg(feature = "film")]
            Self::Film(diagnostics) => json!({
                "format_version": output::FORMAT_VERSION,
                "kind": "problems",
                "problems": diagnostics.problems().iter().map(|problem| json!({
                    "file": problem.file,
                    "line": problem.line,
                    "column": problem.column,
                    "message": problem.message,
                    "help": problem.help,
                })).collect::<Vec<_>>(),
            }),
            #[cfg(feature = "robot")]
            Self::Halted(_) => self.error_json(),
            Self::Input(_) | Self::Runtime(_) | Self::Interrupted => self.error_json(),
        }
    }

    fn error_json(&self) -> Value {
        json!({
            "format_version": output::FORMAT_VERSION,
            "kind": "error",
            "exit_code": self.code(),
            "message": self.message(),
        })
    }
}

fn report_error(error: &anyhow::Error, console: &Console) {
    let title = console.stderr().paint(Colors::Warning, "error:");
    output::note(&format!("{title} {}", words(error)));
}

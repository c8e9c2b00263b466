//! Why a question has no answer.

use coinmc::config::{Diagnostics, OverrideError};
use coinmc::run::RunError;
use coinmc_core::EngineError;
use thiserror::Error;

/// Why a question has no answer.
#[derive(Debug, Error)]
pub enum QuestionError {
    /// Several things are wrong at once.
    #[error("{}", joined(.0))]
    Several(Vec<QuestionError>),
    /// The key of the parameter is none.
    #[error(transparent)]
    Key(OverrideError),
    /// The config has problems, at some value of the parameter.
    #[error("the config has problems:\n{0}")]
    Config(Diagnostics),
    /// The engine refuses its settings.
    #[error(transparent)]
    Engine(EngineError),
    /// A point cannot be computed.
    #[error(transparent)]
    Run(#[from] RunError),
    /// No thread can be started.
    #[error("cannot start a thread: {0}")]
    Thread(std::io::Error),
    /// It was stopped.
    #[error("stopped")]
    Stopped,
    /// The target is not a probability strictly between 0 and 1.
    #[error("the target must be above 0 and below 1, not {0}")]
    Target(f64),
    /// The half width is not positive and finite.
    #[error("the half width must be above 0 and finite, not {0}")]
    HalfWidth(f64),
    /// There are no tosses.
    #[error("at least {least} tosses are needed, not {given}")]
    TooFewTosses {
        /// The fewest.
        least: u64,
        /// Those asked for.
        given: u64,
    },
    /// The ends of the range are not finite, or in the wrong order.
    #[error("the range must lead from a finite number to a larger one, not from {from} to {to}")]
    Range {
        /// The first end.
        from: f64,
        /// The last end.
        to: f64,
    },
    /// The config refuses one end of the range.
    #[error("the range cannot lead {end} {value}: {}", said(problems))]
    RangeEnd {
        /// Which end: `from` or `to`.
        end: &'static str,
        /// Its value.
        value: f64,
        /// The problems of the config there.
        problems: Diagnostics,
    },
    /// A parameter without a range.
    #[error("`{key}` has no natural range: say from where to where to search")]
    NoRange {
        /// Its key in configs.
        key: String,
    },
    /// The size of the coin is not positive and finite.
    #[error("the {what} of the coin must be above 0 and finite, not {given}")]
    Size {
        /// What of it.
        what: &'static str,
        /// The number.
        given: f64,
    },
    /// The size is given twice.
    #[error("the parameter is `{key}`, so the size of the coin cannot be given as well")]
    SizeIsSought {
        /// The key of the parameter.
        key: String,
    },
    /// The relative error is no share.
    #[error("the relative error must be above 0 and at most 0.5, not {0}")]
    RelativeError(f64),
    /// Nothing is unknown.
    #[error("say what is unknown, and from where to where it may be")]
    NoUnknown,
    /// The range of a number is given twice.
    #[error("the range of `{0}` is given twice")]
    Twice(String),
    /// There are too few samples.
    #[error("at least {least} samples are needed, not {given}")]
    TooFewSamples {
        /// The fewest.
        least: u64,
        /// Those asked for.
        given: u64,
    },
    /// Parameters that cannot be varied.
    #[error("{}; choose from {known}", not_varied(keys))]
    NotVaried {
        /// Their keys, each with the nearest of those that can be.
        keys: Vec<(String, Option<String>)>,
        /// The keys that can be.
        known: String,
    },
    /// The step of a difference.
    #[error("the step must be above 0 and at most 1, not {0}")]
    Step(f64),
    /// Not one or two parameters of the launch.
    #[error("one or two different parameters of the launch are needed, not {0}")]
    Parameters(usize),
    /// A key that is not that of a number of the launch.
    #[error("`{key}` is no number of the launch; its numbers are {known}")]
    NotOfLaunch {
        /// The key given.
        key: String,
        /// All keys of numbers.
        known: String,
    },
    /// Too few values of a parameter.
    #[error("at least 2 values of `{key}` are needed, not {given}")]
    TooFewValues {
        /// The key of the parameter.
        key: String,
        /// Those asked for.
        given: usize,
    },
    /// More work than a question may ask for.
    #[error("at most {most} {what} are allowed, not {given}")]
    TooMany {
        /// Of what.
        what: &'static str,
        /// The most.
        most: u64,
        /// Those asked for.
        given: u64,
    },
    /// The config is a sweep.
    #[error("the config must be a single point, but sweeps {0}")]
    Swept(String),
    /// The config's engine is a closed form.
    #[error("a closed form has no launch: choose an engine that tosses")]
    NoLaunch,
    /// A factor of the spread is negative or not finite.
    #[error("a factor for the spread of the hand must be 0 or more and finite, not {0}")]
    Factor(f64),
    /// Every number of the launch is certain.
    #[error("nothing of the launch is spread, so there is no spread to multiply")]
    NoSpread,
    /// The config refuses the spread of a clumsier hand.
    #[error("with {factor} times the spread of the hand, {}", said(problems))]
    Clumsy {
        /// The factor.
        factor: f64,
        /// The problems.
        problems: Diagnostics,
    },
    /// There are no counts.
    #[error("at least one toss must be counted")]
    NoCounts,
    /// No point of a run has tosses.
    #[error("no point has tosses yet: finish the run")]
    NoModel,
    /// No toss of a run shows a face.
    #[error(
        "no toss of any point showed a face (all are undecided or left the table): there is nothing to compare with"
    )]
    NoFaces,
    /// There is no such scene.
    #[error("there is no scene `{name}`{}: known are {known}", nearest.map_or(String::new(), |near| format!(" (did you mean `{near}`?)")))]
    NoScene {
        /// The name given.
        name: String,
        /// The nearest name.
        nearest: Option<&'static str>,
        /// All names.
        known: String,
    },
}

impl QuestionError {
    /// All of these as one error, if there are any.
    pub(crate) fn of_all(mut errors: Vec<Self>) -> Option<Self> {
        match errors.len() {
            0 | 1 => errors.pop(),
            _ => Some(Self::Several(errors)),
        }
    }
}

fn not_varied(keys: &[(String, Option<String>)]) -> String {
    let keys: Vec<String> = keys
        .iter()
        .map(|(key, near)| match near {
            Some(near) => format!("`{key}` (did you mean `{near}`?)"),
            None => format!("`{key}`"),
        })
        .collect();
    let are = match keys.len() {
        1 => "is not a number",
        _ => "are not numbers",
    };
    format!(
        "{} {are} of this config that can be varied",
        keys.join(", ")
    )
}

fn joined(errors: &[QuestionError]) -> String {
    let messages: Vec<String> = errors.iter().map(ToString::to_string).collect();
    messages.join("\n")
}

/// The messages of problems, without their places.
fn said(problems: &Diagnostics) -> String {
    let messages = problems.problems().iter();
    let messages = messages.map(|problem| problem.message.as_str());
    messages.collect::<Vec<_>>().join("; ")
}

impl From<Diagnostics> for QuestionError {
    fn from(diagnostics: Diagnostics) -> Self {
        Self::Config(diagnostics)
    }
}

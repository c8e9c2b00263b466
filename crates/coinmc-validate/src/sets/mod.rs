//! Public data sets, and how well one prior predicts each.
//!
//! What a source states of its coin, table and launch is taken from it; everything else is drawn from the
//! [prior](crate::prior). Nothing is fitted to any set.

mod list;
mod predict;
mod published;

pub(crate) use list::{SETS, UNITY};
pub(crate) use predict::{Draws, predict};

/// What a data set holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Counts of real tosses.
    Tosses,
    /// Counts or a value of a simulation.
    Simulation,
    /// A value of a theory.
    Theory,
}

impl Kind {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Tosses => "tosses",
            Self::Simulation => "simulation",
            Self::Theory => "theory",
        }
    }
}

/// A public data set.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DataSet {
    /// Its name.
    pub name: &'static str,
    /// What it is.
    pub doc: &'static str,
    /// What it holds.
    pub kind: Kind,
    /// Where it comes from.
    pub source: &'static str,
    /// What its source states of coin, table and launch, and so is not drawn from the prior.
    pub stated: &'static str,
    pub(crate) by: Predictor,
}

/// How a data set is predicted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Predictor {
    /// By tosses of each draw from the prior.
    Prior(&'static Experiment),
    /// By tosses of the one scene that its source states in full.
    Stated(&'static Experiment),
    /// Thin coins that are caught, in closed form: only the angle ψ of the hand matters.
    Caught,
    /// Either side is up at the start as often: ½ by symmetry.
    Even,
    /// The arc rule.
    Arc,
    /// Not at all, and why.
    Nothing(&'static str),
}

/// A toss that a source describes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Experiment {
    pub(crate) name: &'static str,
    /// A config, if the source states more than a few numbers of an everyday scene.
    pub(crate) config: Option<&'static str>,
    /// What it states, as in `--set`.
    pub(crate) settings: &'static [&'static str],
    /// What is drawn: all keys that begin so.
    pub(crate) drawn: &'static [&'static str],
}

/// A data set and its prediction.
#[derive(Debug, Clone, PartialEq)]
pub struct Predicted {
    /// The data set.
    pub set: &'static DataSet,
    /// Its lines; none if it was not predicted.
    pub lines: Vec<Line>,
    /// The probability, if the prior is right, of data at least as far out: the smallest p-value of all
    /// lines times their number (Bonferroni). `None` if it was not predicted.
    pub p_value: Option<f64>,
    /// Its standard error, from the number of draws.
    pub p_error: f64,
}

/// One number of a data set.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// Its name.
    pub name: String,
    /// The probability that is meant, in words.
    pub quantity: &'static str,
    /// What was published: a share, or a probability.
    pub seen: f64,
    /// Published tosses; 0 for a value.
    pub tosses: u64,
    /// The mean of the prediction.
    pub predicted: f64,
    /// Where the middle 95 % of the draws lie (of a scene stated in full: the interval of its tosses).
    pub range: [f64; 2],
    /// Its p-value, two-sided.
    pub p_value: f64,
    /// The standard error of the p-value.
    pub p_error: f64,
    /// Our own tosses that it rests on.
    pub own_tosses: u64,
}

impl Predicted {
    /// Why it was not predicted.
    pub fn why_not(&self) -> Option<&'static str> {
        match self.set.by {
            Predictor::Nothing(why) => Some(why),
            _ => None,
        }
    }

    /// Whether the data contradict the prior, by a test with this share of false alarms.
    pub fn is_rejected(&self, level: f64) -> Option<bool> {
        self.p_value.map(|p| p < level)
    }

    /// Our own tosses that it rests on.
    pub fn own_tosses(&self) -> u64 {
        self.lines.iter().map(|line| line.own_tosses).sum()
    }
}

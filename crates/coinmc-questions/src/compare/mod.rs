//! Counts of real tosses against the points of a run.

mod document;
mod exact;

pub use document::document_of_comparison;

use crate::{QuestionError, TEST, tosses_for_power};
use coinmc::results::Row;
use coinmc_core::{Estimate, Face, IntervalMethod};
use exact::{Reference, p_value};
use libm::{exp, lgamma, log};

/// Most tosses that are compared.
pub const MOST_COUNTED: u64 = 1_000_000;
/// Most points that they are compared with.
pub const MOST_MODELS: usize = 10_000;

/// A point of a run as a model of real tosses.
#[derive(Debug, Clone)]
pub struct Model<'a> {
    /// The name of its run.
    pub run: &'a str,
    /// The point.
    pub row: &'a Row,
}

/// Counts and how well each model tells of them.
#[derive(Debug, Clone)]
pub struct Comparison<'a> {
    /// Heads, tails and side.
    pub counts: [u64; 3],
    /// The probabilities by the counts alone, with intervals of this confidence.
    pub seen: [Estimate; 3],
    /// Each model, the most likely first.
    pub models: Vec<Compared<'a>>,
}

/// One model beside the counts.
#[derive(Debug, Clone)]
pub struct Compared<'a> {
    /// The model.
    pub model: Model<'a>,
    /// Its probability, if it is right, of counts that are no more probable than those seen, by an exact test that
    /// knows its own error.
    pub p_value: f64,
    /// Logarithm to the base 10 of the Bayes factor for it, against a coin of which every triple of probabilities
    /// is equally likely.
    pub evidence: f64,
    /// Its probability if one of the models is right and none is more likely beforehand.
    pub share: f64,
    /// Tosses after which [`TEST`] rejects it, if the most likely model is right; for that model itself, if the
    /// shares seen are. `None` where nothing tells the two apart.
    pub tosses_to_tell: Option<u64>,
}

impl Comparison<'_> {
    /// All tosses.
    pub fn tosses(&self) -> u64 {
        self.counts.iter().sum()
    }
}

/// Compares counts of heads, tails and side with models. Points without tosses or a closed form are left out;
/// tosses of a model without a face (undecided, or off the table) are, too.
///
/// # Errors
/// [`QuestionError::NoCounts`], [`QuestionError::TooMany`] tosses or models, [`QuestionError::NoModel`],
/// [`QuestionError::NoFaces`].
///
/// # Example
/// ```
/// use coinmc::{config, results::{Results, Row}, plan::StoppedBy};
/// use coinmc_questions::{compare, Model};
/// let plan = config::parse("inline", "coin.ratio = [0.5, 1.5]\nengine.analytic.rule = 'cross-section'", &[])?;
/// let row = |index| Row::new(&plan, index, Default::default(), StoppedBy::Tosses);
/// let rows = [row(0), row(1)];
/// let models: Vec<_> = rows.iter().map(|row| Model { run: "rule", row }).collect();
/// let compared = compare([41, 38, 21], &models, 0.95)?;
/// // x/(2 + x) is 0.2 for the thinner coin and 0.43 for the thicker one
/// assert_eq!(compared.models[0].model.row.point, 0);
/// assert!(compared.models[0].p_value > 0.5 && compared.models[1].p_value < 1e-4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn compare<'a>(
    counts: [u64; 3],
    models: &[Model<'a>],
    confidence: f64,
) -> Result<Comparison<'a>, QuestionError> {
    let tosses = counts
        .iter()
        .try_fold(0_u64, |sum, count| sum.checked_add(*count))
        .unwrap_or(u64::MAX);
    let too_many = |what, most: u64, given| Err(QuestionError::TooMany { what, most, given });
    if tosses == 0 {
        return Err(QuestionError::NoCounts);
    } else if tosses > MOST_COUNTED {
        return too_many("tosses", MOST_COUNTED, tosses);
    }
    let known: Vec<_> = models.iter().filter_map(reference).collect();
    if known.is_empty() {
        let is_tossed = |model: &Model<'_>| model.row.tally.tosses() > 0;
        return Err(if models.iter().any(is_tossed) {
            QuestionError::NoFaces
        } else {
            QuestionError::NoModel
        });
    } else if known.len() > MOST_MODELS {
        return too_many("points", MOST_MODELS as u64, known.len() as u64);
    }
    let compared = known.into_iter().map(|(model, reference)| Compared {
        model,
        p_value: p_value(&reference, counts),
        evidence: (ln_evidence(&reference, counts) - ln_uniform(counts)) / std::f64::consts::LN_10,
        share: 0.0,
        tosses_to_tell: None,
    });
    let mut models: Vec<Compared<'a>> = compared.collect();
    models.sort_by(|a, b| b.evidence.total_cmp(&a.evidence));
    share_out(&mut models);
    let seen =
        counts.map(|count| Estimate::new(count, 0, tosses, confidence, IntervalMethod::Wilson));
    let best = of_model(models[0].model.row);
    for (place, compared) in models.iter_mut().enumerate() {
        let right = if place == 0 { shares(counts) } else { best };
        compared.tosses_to_tell = tosses_to_tell(of_model(compared.model.row), right);
    }
    Ok(Comparison {
        counts,
        seen,
        models,
    })
}

/// What a point says; `None` if it says nothing yet.
fn reference<'a>(model: &Model<'a>) -> Option<(Model<'a>, Reference)> {
    let row = model.row;
    let tally = &row.tally;
    let counts = [tally.heads, tally.tails, tally.side];
    let reference = if tally.tosses() > 0 {
        (counts.iter().any(|count| *count > 0)).then_some(Reference::Counted(counts))
    } else {
        let p = Face::ALL.map(|face| row.estimate(face).p);
        p.iter()
            .all(|p| p.is_finite())
            .then_some(Reference::Known(p))
    };
    reference.map(|reference| (model.clone(), reference))
}

/// Natural logarithm of the probability of the counts in one order. A model that was tossed has the probabilities of
/// Jeffreys' posterior, Dirichlet(m + 1/2).
fn ln_evidence(reference: &Reference, counts: [u64; 3]) -> f64 {
    match reference {
        Reference::Known(p) => {
            let terms = p.iter().zip(counts);
            terms
                .filter(|(_, count)| *count > 0)
                .map(|(p, count)| count as f64 * log(*p))
                .sum()
        }
        Reference::Counted(model) => ln_dirichlet(counts, model.map(|count| count as f64 + 0.5)),
    }
}

fn ln_uniform(counts: [u64; 3]) -> f64 {
    ln_dirichlet(counts, [1.0; 3])
}

/// ∫ Π p^k Dir(p; a) dp = Γ(A)/Γ(n + A) Π Γ(k + a)/Γ(a).
fn ln_dirichlet(counts: [u64; 3], a: [f64; 3]) -> f64 {
    let whole: f64 = a.iter().sum();
    let n = counts.iter().sum::<u64>() as f64;
    let faces = counts.into_iter().zip(a);
    lgamma(whole) - lgamma(n + whole)
        + faces
            .map(|(count, a)| lgamma(count as f64 + a) - lgamma(a))
            .sum::<f64>()
}

/// Fills in each model's probability, the first being the most likely.
fn share_out(models: &mut [Compared<'_>]) {
    let best = models[0].evidence;
    let weight = |model: &Compared<'_>| {
        if model.evidence == best {
            1.0
        } else {
            exp((model.evidence - best) * std::f64::consts::LN_10)
        }
    };
    let all: f64 = models.iter().map(weight).sum();
    for model in models {
        model.share = weight(model) / all;
    }
}

/// Probabilities by counts, none of them 0.
fn shares(counts: [u64; 3]) -> [f64; 3] {
    let whole = counts.iter().sum::<u64>() as f64 + 1.5;
    counts.map(|count| (count as f64 + 0.5) / whole)
}

/// The probabilities of a point, of the faces alone.
fn of_model(row: &Row) -> [f64; 3] {
    let tally = &row.tally;
    if tally.tosses() > 0 {
        shares([tally.heads, tally.tails, tally.side])
    } else {
        Face::ALL.map(|face| row.estimate(face).p)
    }
}

fn tosses_to_tell(model: [f64; 3], right: [f64; 3]) -> Option<u64> {
    let told = model.iter().all(|p| *p > 0.0 && *p < 1.0);
    (told && model != right).then(|| tosses_for_power(model, right, TEST))
}

//! Which unknown of a scene matters most?
//!
//! # Method
//! Each unknown number θ_k may be anywhere in its range, so the probability P(θ) has a distribution. The
//! indices of Sobol' (Mathematics and Computers in Simulation 55 (2001) 271) divide its variance V:
//!
//! ```text
//! S_k = Var E[P | θ_k]/V          what θ_k explains alone: how much knowing it would take away
//! T_k = 1 − Var E[P | θ_~k]/V     what it takes part in:   how much is left if only it is unknown
//! ```
//!
//! θ_~k are all others. ΣS ≤ 1 ≤ ΣT, both equal where effects only add up. They are estimated by picking
//! and freezing: of two independent places A and B in all ranges, C_k is B with the θ_k of A. Then
//! Var E[P | θ_k] = Cov(P(A), P(C_k)) and Var E[P | θ_~k] = Cov(P(B), P(C_k)).
//!
//! No P is known: each is the share of a few tosses, different ones at each place, so that their chance is
//! in no covariance; what it adds to the variance is taken off (see `indices`).
//!
//! Undecided tosses could have shown the face or not, so what is known is the probability X of a toss that showed
//! it and that V, between 0 and the share U of undecided tosses, is missing: P = X + V. Standard deviations
//! are lengths, and conditional means are projections, so those of P and X differ by at most w = sd(V), and
//! w² ≤ E max(c, U − c)² for any c; half the mean of U is taken. All intervals are as much wider (see `samples`), and
//! P moves only if it does whatever V is.
//!
//! The same numbers one at a time, from end to end of their ranges with the others as the config has them,
//! are the bars of a tornado: by paired tosses.

mod document;
mod indices;
mod picture;
mod samples;

pub use document::document_of_ranking;
pub use picture::picture_of_ranking;

use crate::interval::Interval;
use crate::scenes::Assumption;
use crate::sensitivity::{LEAST_TOSSES, each_varied, parameters};
use crate::span::Span;
use crate::workers::At;
use crate::{QuestionError, Template, Workers};
use coinmc::plan::Plan;
use coinmc_core::{Estimate, Face};
use samples::Samples;

/// Least number of samples: with fewer the intervals mean nothing.
pub const LEAST_SAMPLES: u64 = 64;
/// Most samples.
pub const MOST_SAMPLES: u64 = 1_000_000;
/// Most unknowns.
pub const MOST_UNKNOWNS: usize = 32;

/// A number of a scene that is known only to lie in a range.
#[derive(Debug, Clone, PartialEq)]
pub struct Unknown {
    /// Its key in configs.
    pub key: String,
    /// The least that it may be.
    pub from: f64,
    /// The most. All values are as likely, or all logarithms where to > 10 · from > 0.
    pub to: f64,
}

impl From<Assumption> for Unknown {
    fn from(assumed: Assumption) -> Self {
        Self {
            key: assumed.key.to_owned(),
            from: assumed.low,
            to: assumed.high,
        }
    }
}

impl Unknown {
    /// Its value at this share of its range, 0 to 1.
    ///
    /// # Example
    /// ```
    /// use coinmc_questions::Unknown;
    /// let of = |from, to| Unknown { key: "surface.friction".to_owned(), from, to }.at(0.5);
    /// assert!((of(0.1, 0.3) - 0.2).abs() < 1e-15);
    /// assert!((of(0.01, 1.0) - 0.1).abs() < 1e-15);    // more than a factor of 10: in the logarithm
    /// ```
    pub fn at(&self, share: f64) -> f64 {
        self.span().at(share)
    }

    fn span(&self) -> Span {
        let (from, to) = (self.from, self.to);
        Span { from, to }
    }
}

/// Which unknown matters most?
///
/// # Example
/// Of a coin that does not bounce the thickness matters and the friction does not.
/// ```
/// use coinmc_core::Face;
/// use coinmc_questions::{Rank, Template, Unknown, Workers, rank};
/// use std::sync::atomic::AtomicBool;
/// let text = "coin.ratio = 1.0\nsurface = { landing = 'adhesive', restitution = 0.0, friction = 0.3 }\n\
///             launch.preset = 'clean-flat'\nengine.flat = {}";
/// let unknown = |key: &str, from, to| Unknown { key: key.to_owned(), from, to };
/// let unknowns = vec![unknown("coin.ratio", 0.5, 1.5), unknown("surface.friction", 0.1, 0.5)];
/// let question = Rank { face: Face::Side, unknowns, samples: 400, tosses: 1024 };
/// let cancel = AtomicBool::new(false);
/// let workers = Workers { threads: None, cancel: &cancel, made: &|_| () };
/// let ranking = rank(&Template::new("inline", text, &[]), &question, &workers)?;
/// assert_eq!(ranking.numbers[0].unknown.key, "coin.ratio");
/// assert!(ranking.numbers[0].total.unwrap().hi > 0.9);
/// assert!(ranking.numbers[1].total.unwrap().lo < 0.1);
/// # Ok::<(), coinmc_questions::QuestionError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Rank {
    /// The face.
    pub face: Face,
    /// What is unknown.
    pub unknowns: Vec<Unknown>,
    /// Pairs of places in the ranges.
    pub samples: u64,
    /// Tosses at each end of each range.
    pub tosses: u64,
}

/// The answer to a [`Rank`].
#[derive(Debug, Clone, PartialEq)]
pub struct Ranking {
    /// The question.
    pub question: Rank,
    /// The face's probability where all numbers are as the config has them.
    pub p: Estimate,
    /// Its mean over all ranges.
    pub mean: Interval,
    /// Its standard deviation over all ranges, without the chance of the tosses. The lower end is 0
    /// where the tosses do not show that it moves at all.
    pub deviation: Interval,
    /// The unknowns, the one that matters most first.
    pub numbers: Vec<Ranked>,
    /// Confidence of all intervals.
    pub confidence: f64,
    /// Name of the engine.
    pub engine: &'static str,
    /// Name of its law of impact.
    pub law: &'static str,
    /// All tosses that were made.
    pub tosses: u64,
    /// Tosses of the samples without a face.
    pub undecided: u64,
}

/// How much an unknown matters.
#[derive(Debug, Clone, PartialEq)]
pub struct Ranked {
    /// The unknown.
    pub unknown: Unknown,
    /// The number in the config.
    pub value: f64,
    /// The face's probability at both ends of the range, the others as in the config.
    pub ends: [Interval; 2],
    /// Undecided tosses at either end. The intervals hold whatever they would have shown.
    pub undecided: [u64; 2],
    /// The first-order index S_k; `None` if the probability does not move measurably.
    pub first: Option<Interval>,
    /// The total index T_k.
    pub total: Option<Interval>,
}

impl Ranked {
    /// How far apart the probabilities at the two ends are.
    pub fn swing(&self) -> f64 {
        (self.ends[1].value - self.ends[0].value).abs()
    }
}

/// Answers a [`Rank`]. The answer does not depend on the number of threads.
///
/// # Errors
/// [`QuestionError`] if the question, or the config at some place in the ranges, has problems, or it was
/// stopped.
pub fn rank(
    template: &Template,
    question: &Rank,
    workers: &Workers<'_>,
) -> Result<Ranking, QuestionError> {
    check(question)?;
    let (own, spelled_out) = template.spelled_out()?;
    let unknowns = &question.unknowns;
    let keys = unknowns.iter().map(|unknown| unknown.key.as_str());
    let values = each_varied(&parameters(template)?, keys, |key| own.number(key))?;
    // every problem at an end of a range is found before the first toss
    let ends = ends(&spelled_out, unknowns)?;
    let (p, at_ends) = tornado(question, &own, &ends, workers)?;
    let samples = Samples::make(&spelled_out, question, own.seed, workers)?;
    let (mean, deviation) = samples.moments(own.confidence);
    let moves = deviation.lo > 0.0;
    let ranked = |(k, (unknown, value)): (usize, (&Unknown, f64))| Ranked {
        unknown: unknown.clone(),
        value,
        ends: [at_ends[2 * k].p, at_ends[2 * k + 1].p],
        undecided: [at_ends[2 * k].undecided, at_ends[2 * k + 1].undecided],
        first: moves.then(|| samples.first(k, own.confidence)),
        total: moves.then(|| samples.total(k, own.confidence)),
    };
    let mut numbers: Vec<Ranked> = unknowns
        .iter()
        .zip(values)
        .enumerate()
        .map(ranked)
        .collect();
    let weight = |ranked: &Ranked| ranked.total.map_or(0.0, |total| total.value);
    numbers.sort_by(|a, b| {
        let by_total = weight(b).total_cmp(&weight(a));
        by_total.then(b.swing().total_cmp(&a.swing()))
    });
    let point = &own.points[0];
    Ok(Ranking {
        question: question.clone(),
        p,
        mean,
        deviation,
        numbers,
        confidence: own.confidence,
        engine: point.engine.descriptor().name,
        law: point.engine.law(),
        tosses: question.tosses * (1 + 2 * unknowns.len() as u64) + samples.tosses(),
        undecided: samples.undecided(),
    })
}

impl Rank {
    /// Tosses that the answer will take, for a display of progress.
    pub fn tosses_planned(&self) -> u64 {
        let unknowns = self.unknowns.len() as u64;
        let of_samples = samples::tosses(self).saturating_mul(self.samples);
        of_samples.saturating_add(self.tosses.saturating_mul(1 + 2 * unknowns))
    }
}

/// Everything that is wrong with the question, whatever the config.
fn check(question: &Rank) -> Result<(), QuestionError> {
    let unknowns = &question.unknowns;
    if unknowns.is_empty() {
        return Err(QuestionError::NoUnknown);
    }
    let mut refused = vec![];
    for (what, given, most) in [
        (
            "unknown numbers",
            unknowns.len() as u64,
            MOST_UNKNOWNS as u64,
        ),
        ("samples", question.samples, MOST_SAMPLES),
        ("tosses of an end", question.tosses, crate::MOST_TOSSES),
    ] {
        if given > most {
            refused.push(QuestionError::TooMany { what, most, given });
        }
    }
    for (index, unknown) in unknowns.iter().take(MOST_UNKNOWNS).enumerate() {
        refused.extend(unknown.span().check().err());
        let mut before = unknowns[..index].iter();
        if before.any(|other| other.key == unknown.key) {
            refused.push(QuestionError::Twice(unknown.key.clone()));
        }
    }
    if question.samples < LEAST_SAMPLES {
        refused.push(QuestionError::TooFewSamples {
            least: LEAST_SAMPLES,
            given: question.samples,
        });
    }
    if question.tosses < LEAST_TOSSES {
        refused.push(QuestionError::TooFewTosses {
            least: LEAST_TOSSES,
            given: question.tosses,
        });
    }
    QuestionError::of_all(refused).map_or(Ok(()), Err)
}

/// The plans at both ends of all ranges.
fn ends(template: &Template, unknowns: &[Unknown]) -> Result<Vec<Plan>, QuestionError> {
    let ends = unknowns
        .iter()
        .flat_map(|unknown| [(unknown, unknown.from), (unknown, unknown.to)]);
    ends.map(|(unknown, end)| template.plan(&[(&unknown.key, format!("{end:?}"))]))
        .collect()
}

/// One end of a range.
struct End {
    p: Interval,
    undecided: u64,
}

/// The face's probability with the config's own numbers, and at the ends of all ranges.
fn tornado(
    question: &Rank,
    own: &Plan,
    ends: &[Plan],
    workers: &Workers<'_>,
) -> Result<(Estimate, Vec<End>), QuestionError> {
    let at = |plan| At { plan, point: 0 };
    let ends: Vec<_> = ends.iter().map(at).collect();
    let changes = workers.compare_with(at(own), &ends, 0..question.tosses)?;
    let p = changes[0].seen(question.face)[0].estimate(own);
    let ends = changes.iter().map(|changes| {
        let [_, seen] = changes.seen(question.face);
        let Estimate { p, lo, hi, .. } = seen.estimate(own);
        let p = Interval { value: p, lo, hi };
        let undecided = seen.undecided;
        End { p, undecided }
    });
    Ok((p, ends.collect()))
}

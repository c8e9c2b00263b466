//! Places in the ranges, and tosses at each.

use super::indices::Pairs;
use super::{Interval, Rank};
use crate::workers::{At, ENDS, UNDECIDED};
use crate::{QuestionError, Template, Workers};
use coinmc_core::{Domain, Stream, UniformSource};

/// Tosses at each place. With a variance V of the probability and p(1 − p) of a toss, the error of a
/// covariance by all tosses together is least with about p(1 − p)/V of them at a place: for
/// probabilities that move by 0.1 some 20. A plan must be made for each place, so a few more.
const TOSSES: u64 = 32;

/// The shares of the face at all places of all samples.
pub(super) struct Samples {
    /// For each sample those at A, B, C_0, C_1, …
    shares: Vec<Vec<f64>>,
    undecided: u64,
    places: u64,
}

/// Tosses of each sample.
pub(super) fn tosses(question: &Rank) -> u64 {
    places(question) * TOSSES
}

fn places(question: &Rank) -> u64 {
    question.unknowns.len() as u64 + 2
}

impl Samples {
    pub(super) fn make(
        template: &Template,
        question: &Rank,
        seed: u64,
        workers: &Workers<'_>,
    ) -> Result<Self, QuestionError> {
        let stream = Stream::new(seed, Domain::Parameters, 0);
        let samples = usize::try_from(question.samples).expect("checked");
        let counted = workers.each(samples, &|sample| {
            let sample = sample as u64;
            let places = values(question, &stream, sample);
            let mut counted = vec![];
            for (place, values) in places.iter().enumerate() {
                // no two places share a toss
                let first = sample * tosses(question) + place as u64 * TOSSES;
                let shown = shown(template, question, values, first, workers)?;
                counted.push(shown);
            }
            Ok::<_, QuestionError>(counted)
        })?;
        let undecided = counted.iter().flatten().map(|(_, undecided)| undecided);
        let share = |(shown, _): &(u64, u64)| *shown as f64 / TOSSES as f64;
        Ok(Self {
            undecided: undecided.sum(),
            shares: counted
                .iter()
                .map(|places| places.iter().map(share).collect())
                .collect(),
            places: places(question),
        })
    }

    pub(super) fn tosses(&self) -> u64 {
        self.shares.len() as u64 * self.places * TOSSES
    }

    pub(super) fn undecided(&self) -> u64 {
        self.undecided
    }

    /// The mean of the probability, and its standard deviation.
    pub(super) fn moments(&self, confidence: f64) -> (Interval, Interval) {
        let pairs = self.pairs([0, 1], confidence);
        let root = |variance: f64| variance.max(0.0).sqrt();
        let Interval { value, lo, hi } = pairs.variance();
        let deviation = Interval {
            value: root(value),
            lo: root(lo),
            hi: root(hi),
        };
        (pairs.mean(), deviation)
    }

    /// S of the unknown of this index: A and C_k have only it in common.
    pub(super) fn first(&self, k: usize, confidence: f64) -> Interval {
        self.pairs([0, k + 2], confidence).correlation()
    }

    /// T: B and C_k have all others in common.
    pub(super) fn total(&self, k: usize, confidence: f64) -> Interval {
        let Interval { value, lo, hi } = self.pairs([1, k + 2], confidence).correlation();
        Interval {
            value: 1.0 - value,
            lo: 1.0 - hi,
            hi: 1.0 - lo,
        }
    }

    fn pairs(&self, places: [usize; 2], confidence: f64) -> Pairs {
        let pairs = self.shares.iter();
        Pairs::new(
            pairs.map(|shares| places.map(|place| shares[place])),
            TOSSES,
            confidence,
        )
    }
}

/// The unknowns at the places A, B, C_0, C_1, … of a sample.
fn values(question: &Rank, stream: &Stream, sample: u64) -> Vec<Vec<f64>> {
    let unknowns = &question.unknowns;
    let mut uniforms = stream.toss(sample);
    let mut dimension = 0..;
    let mut place = || -> Vec<f64> {
        let next = |unknown: &super::Unknown| {
            let dimension = dimension.next().expect("endless");
            unknown.span().at(uniforms.uniform(dimension))
        };
        unknowns.iter().map(next).collect()
    };
    let (a, b) = (place(), place());
    let mut places = vec![a.clone(), b.clone()];
    for k in 0..unknowns.len() {
        let mut mixed = b.clone();
        mixed[k] = a[k];
        places.push(mixed);
    }
    places
}

/// How many tosses show the face with these values, and how many none.
fn shown(
    template: &Template,
    question: &Rank,
    values: &[f64],
    first: u64,
    workers: &Workers<'_>,
) -> Result<(u64, u64), QuestionError> {
    let keys = question.unknowns.iter().map(|unknown| &*unknown.key);
    let values: Vec<_> = keys
        .zip(values)
        .map(|(key, value)| (key, format!("{value:?}")))
        .collect();
    let plan = template.plan(&values)?;
    let at = At {
        plan: &plan,
        point: 0,
    };
    let mut counts = [0; ENDS];
    workers.ends(at, first..first + TOSSES, &mut |_, end| counts[end] += 1)?;
    Ok((counts[question.face as usize], counts[UNDECIDED]))
}

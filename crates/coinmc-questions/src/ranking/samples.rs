//! Places in the ranges, and tosses at each.

use super::indices::Pairs;
use super::{Interval, Rank};
use crate::changes::{ENDS, UNDECIDED};
use crate::workers::At;
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
    /// The undecided tosses at the places A and B, as shares.
    open: Vec<f64>,
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
        let open = |(_, undecided): &(u64, u64)| *undecided as f64 / TOSSES as f64;
        let independent = counted.iter().flat_map(|places| &places[..2]);
        Ok(Self {
            open: independent.map(open).collect(),
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
        let mean = pairs.mean();
        let deviation = self.deviation(confidence);
        let hidden = hidden_deviation(&self.open);
        let mean = Interval {
            hi: mean.hi + average(&self.open),
            ..mean
        };
        let deviation = Interval {
            value: deviation.value,
            lo: (deviation.lo - hidden).max(0.0),
            hi: deviation.hi + hidden,
        };
        (mean, deviation)
    }

    /// The standard deviation of the probability of tosses that showed the face.
    fn deviation(&self, confidence: f64) -> Interval {
        let root = |variance: f64| variance.max(0.0).sqrt();
        let Interval { value, lo, hi } = self.pairs([0, 1], confidence).variance();
        Interval {
            value: root(value),
            lo: root(lo),
            hi: root(hi),
        }
    }

    /// S of the unknown of this index: A and C_k have only it in common.
    pub(super) fn first(&self, k: usize, confidence: f64) -> Interval {
        let index = self.pairs([0, k + 2], confidence).correlation();
        self.widened(index, confidence)
    }

    /// T: B and C_k have all others in common.
    pub(super) fn total(&self, k: usize, confidence: f64) -> Interval {
        let Interval { value, lo, hi } = self.pairs([1, k + 2], confidence).correlation();
        let index = Interval {
            value: 1.0 - value,
            lo: 1.0 - hi,
            hi: 1.0 - lo,
        };
        self.widened(index, confidence)
    }

    /// An index with room for what the undecided tosses would have shown. Its root is the length of a part of P over
    /// that of all of P, and either length is known to the hidden deviation, which is less than the least deviation
    /// where indices are asked for.
    fn widened(&self, index: Interval, confidence: f64) -> Interval {
        let hidden = hidden_deviation(&self.open) / self.deviation(confidence).lo;
        if hidden == 0.0 {
            return index;
        }
        let part = |index: f64| index.max(0.0).sqrt();
        let lo = (part(index.lo) - hidden).max(0.0) / (1.0 + hidden);
        let hi = (part(index.hi) + hidden) / (1.0 - hidden);
        Interval {
            value: index.value,
            lo: (lo * lo).min(index.lo),
            // no index is above 1
            hi: (hi * hi).min(1.0).max(index.hi),
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

/// The most by which undecided tosses can change the standard deviation of the probability, by their shares at
/// places all over the ranges. Each is of a few tosses, whose chance makes this no smaller on average.
fn hidden_deviation(open: &[f64]) -> f64 {
    let middle = 0.5 * average(open);
    let farthest = open.iter().map(|share| middle.max(share - middle));
    let squares: Vec<f64> = farthest.map(|far| far * far).collect();
    average(&squares).sqrt()
}

fn average(numbers: &[f64]) -> f64 {
    numbers.iter().sum::<f64>() / numbers.len() as f64
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Half of the places showed the face in no toss and half in so many of them; a third of the variance comes from the
    /// unknown, the rest from others.
    fn samples(most: f64, open: f64) -> Samples {
        let at = |sample: u32| {
            let of = |high: bool| if high { most } else { 0.0 };
            let (a, b) = (sample.is_multiple_of(2), sample % 4 < 2);
            let mixed = if sample.is_multiple_of(3) { a } else { b };
            vec![of(a), of(b), of(mixed)]
        };
        Samples {
            shares: (0..20_000).map(at).collect(),
            open: vec![open; 40_000],
            undecided: 0,
            places: 3,
        }
    }

    #[test]
    fn undecided_tosses_hide_half_their_share_of_the_deviation() {
        assert_eq!(hidden_deviation(&[0.0; 4]), 0.0);
        assert!((hidden_deviation(&[0.3; 4]) - 0.15).abs() < 1e-12);
        // about 0.1: at most 0.1 away from it at one half of the places, 0.3 at the other
        assert!((hidden_deviation(&[0.0, 0.4]) - 0.05_f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn undecided_tosses_widen_mean_deviation_and_indices() {
        let (known, open) = (samples(0.6, 0.0), samples(0.6, 0.02));
        let ([mean, deviation], [open_mean, open_deviation]) =
            (known.moments(0.95).into(), open.moments(0.95).into());
        assert_eq!((open_mean.value, open_mean.lo), (mean.value, mean.lo));
        assert!((open_mean.hi - mean.hi - 0.02).abs() < 1e-12);
        assert!((deviation.lo - open_deviation.lo - 0.01).abs() < 1e-12);
        assert!((open_deviation.hi - deviation.hi - 0.01).abs() < 1e-12);
        let (index, wider) = (known.first(0, 0.95), open.first(0, 0.95));
        let hidden = 0.01 / deviation.lo;
        assert_eq!(wider.value, index.value);
        assert!((wider.lo.sqrt() - (index.lo.sqrt() - hidden) / (1.0 + hidden)).abs() < 1e-12);
        assert!((wider.hi.sqrt() - (index.hi.sqrt() + hidden) / (1.0 - hidden)).abs() < 1e-12);
        assert!(open.total(0, 0.95).hi > known.total(0, 0.95).hi);
        assert_eq!(samples(0.6, 0.4).first(0, 0.95).hi, 1.0);
    }

    #[test]
    fn enough_undecided_tosses_hide_that_it_moves() {
        assert!(samples(0.2, 0.0).moments(0.95).1.lo > 0.05);
        assert_eq!(samples(0.2, 0.3).moments(0.95).1.lo, 0.0);
    }
}

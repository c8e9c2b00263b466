//! Launches that are drawn, and those of them that are tossed.

use super::interval::Counted;
use super::strata::{STRATA, Strata};
use super::touch::inclination;
use crate::{QuestionError, Workers};
use coinmc::plan::Plan;
use coinmc::run::{TossSource, for_each_outcome, stream};
use coinmc_core::{Domain, Face, Launch, Stream, UniformSource};
use std::ops::Range;
use std::sync::atomic::Ordering;

/// Launches of one piece of work.
const PIECE: u64 = 4096;
/// Launches whose pieces are held in memory at a time: some 16 MB.
const BLOCK: u64 = 1 << 26;

/// The launches of a scene by number: those of its first point, as in a run of it.
pub(super) struct Launches<'a> {
    plan: &'a Plan,
    face: Face,
    drawn: Stream,
    accepted: Stream,
    workers: &'a Workers<'a>,
}

/// What came of launches.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tossed {
    /// Launches of each stratum.
    pub(super) launches: Vec<u64>,
    /// Its tosses.
    pub(super) counts: Vec<Counted>,
}

impl Tossed {
    pub(super) fn none() -> Self {
        Self {
            launches: vec![0; STRATA],
            counts: vec![Counted::default(); STRATA],
        }
    }

    pub(super) fn add(&mut self, other: &Self) {
        for (sum, launches) in self.launches.iter_mut().zip(&other.launches) {
            *sum += launches;
        }
        for (sum, counted) in self.counts.iter_mut().zip(&other.counts) {
            sum.tosses += counted.tosses;
            sum.shown += counted.shown;
            sum.undecided += counted.undecided;
            sum.work += counted.work;
        }
    }

    pub(super) fn tosses(&self) -> u64 {
        self.counts.iter().map(|counted| counted.tosses).sum()
    }

    /// Share of the launches in each stratum.
    pub(super) fn shares(&self) -> Vec<f64> {
        let all: u64 = self.launches.iter().sum();
        let shares = self.launches.iter();
        shares
            .map(|launches| *launches as f64 / all as f64)
            .collect()
    }
}

impl<'a> Launches<'a> {
    pub(super) fn new(plan: &'a Plan, face: Face, workers: &'a Workers<'a>) -> Self {
        Self {
            plan,
            face,
            drawn: stream(plan, 0),
            accepted: Stream::new(plan.seed, Domain::Acceptance, 0),
            workers,
        }
    }

    /// The inclinations at first touch of launches.
    pub(super) fn inclinations(&self, numbers: Range<u64>) -> Result<Vec<f64>, QuestionError> {
        let pieces = self.in_pieces(numbers, &|numbers| {
            Ok(numbers
                .map(|number| self.drawn(number).1)
                .collect::<Vec<_>>())
        })?;
        Ok(pieces.concat())
    }

    /// Tosses the launches of each stratum with its chance.
    pub(super) fn toss(
        &self,
        numbers: Range<u64>,
        strata: &Strata,
        chances: &[f64],
    ) -> Result<Tossed, QuestionError> {
        let mut all = Tossed::none();
        let mut first = numbers.start;
        while first < numbers.end {
            let end = numbers.end.min(first + BLOCK);
            for piece in self.toss_block(first..end, strata, chances)? {
                all.add(&piece);
            }
            first = end;
        }
        Ok(all)
    }

    fn toss_block(
        &self,
        numbers: Range<u64>,
        strata: &Strata,
        chances: &[f64],
    ) -> Result<Vec<Tossed>, QuestionError> {
        self.in_pieces(numbers, &|numbers| {
            let mut tossed = Tossed::none();
            let mut accepted = vec![];
            for number in numbers {
                let (launch, inclination) = self.drawn(number);
                let stratum = strata.index(inclination);
                tossed.launches[stratum] += 1;
                // an open interval: a chance of 1 accepts all
                if self.accepted.toss(number).uniform(0) < chances[stratum] {
                    accepted.push((launch, stratum));
                }
            }
            self.count(&accepted, &mut tossed.counts)?;
            Ok(tossed)
        })
    }

    fn drawn(&self, number: u64) -> (Launch, f64) {
        let point = &self.plan.points[0];
        let launch = TossSource::Drawn(&self.drawn).launch(point, number);
        let (coin, gravity) = (&point.scene.coin, point.scene.gravity_m_s2());
        (launch, inclination(coin, &launch, gravity))
    }

    /// Tosses launches, and counts by stratum.
    fn count(
        &self,
        accepted: &[(Launch, usize)],
        counts: &mut [Counted],
    ) -> Result<(), QuestionError> {
        let index = |toss: u64| usize::try_from(toss).expect("a piece is small");
        let given = |toss| accepted[index(toss)].0;
        let go_on = || !self.workers.cancel.load(Ordering::Relaxed);
        let tosses = 0..accepted.len() as u64;
        for_each_outcome(
            &self.plan.points[0],
            TossSource::Given(&given),
            tosses,
            |toss, outcome| {
                let counted = &mut counts[accepted[index(toss)].1];
                counted.tosses += 1;
                counted.work += 1 + u64::from(outcome.impacts) + u64::from(outcome.contact_steps);
                counted.shown += u64::from(outcome.face() == Some(self.face));
                counted.undecided += u64::from(outcome.is_undecided());
                go_on()
            },
        )
        .map_err(QuestionError::Engine)?;
        if !go_on() {
            return Err(QuestionError::Stopped);
        }
        (self.workers.made)(accepted.len() as u64);
        Ok(())
    }

    fn in_pieces<T: Send>(
        &self,
        numbers: Range<u64>,
        compute: &(dyn Fn(Range<u64>) -> Result<T, QuestionError> + Sync),
    ) -> Result<Vec<T>, QuestionError> {
        let pieces = (numbers.end - numbers.start).div_ceil(PIECE);
        let pieces = usize::try_from(pieces).expect("limited");
        self.workers.each(pieces, &|piece| {
            if self.workers.cancel.load(Ordering::Relaxed) {
                return Err(QuestionError::Stopped);
            }
            let first = numbers.start + piece as u64 * PIECE;
            compute(first..numbers.end.min(first + PIECE))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenes::EverydayScene;
    use crate::workers::At;
    use std::sync::atomic::AtomicBool;

    fn workers(cancel: &AtomicBool) -> Workers<'_> {
        Workers {
            threads: None,
            cancel,
            made: &|_| (),
        }
    }

    /// A launch that is tossed comes down as in a run, also on rough ground; and which are tossed is a matter of
    /// their numbers alone.
    #[test]
    fn tosses_are_those_of_a_run() {
        let cancel = AtomicBool::new(false);
        let workers = workers(&cancel);
        let felt = EverydayScene::named("felt").expect("a scene");
        let sets = ["coin.ratio=0.7".parse().expect("an override")];
        let plan = felt.template(&sets).plan(&[]).expect("a plan");
        let launches = Launches::new(&plan, Face::Side, &workers);
        let strata = Strata::of(launches.inclinations(0..1 << 12).expect("launches"));
        let all = launches
            .toss(0..6000, &strata, &[1.0; STRATA])
            .expect("tosses");
        let at = At {
            plan: &plan,
            point: 0,
        };
        let [counts] = workers.count(&[(at, 0..6000)]).expect("tosses")[..] else {
            panic!("one");
        };
        let shown: u64 = all.counts.iter().map(|counted| counted.shown).sum();
        assert!(shown > 100);
        assert_eq!((all.tosses(), shown), (6000, counts[Face::Side as usize]));
        let half = [0.5; STRATA];
        let mut parts = launches.toss(0..3000, &strata, &half).expect("tosses");
        parts.add(&launches.toss(3000..6000, &strata, &half).expect("tosses"));
        assert_eq!(
            parts,
            launches.toss(0..6000, &strata, &half).expect("tosses")
        );
        // 3000 of 6000 with a standard error of 39
        assert!(parts.tosses().abs_diff(3000) < 130, "{}", parts.tosses());
        assert_eq!(parts.launches, all.launches);
    }
}

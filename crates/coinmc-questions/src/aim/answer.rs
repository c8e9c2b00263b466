//! The search in the plane of launches by an engine's tosses.

use super::check::Plans;
use super::search::{Effort, Found, Places, Searched, planned as planned_search, search};
use super::{Aim, Aimed, Clumsy, Place};
use crate::seen::Seen;
use crate::workers::At;
use crate::{QuestionError, Workers};
use coinmc::plan::Plan;
use coinmc_core::Face;
use std::ops::Range;

/// The places of a plane, tossed by the engine of their plans.
struct Arena<'a> {
    places: &'a [Plan],
    face: Face,
    workers: &'a Workers<'a>,
}

impl Places for Arena<'_> {
    type Error = QuestionError;

    fn count(&mut self, places: &[usize], tosses: Range<u64>) -> Result<Vec<Seen>, QuestionError> {
        let plans = places.iter().map(|&place| &self.places[place]);
        count(plans, &tosses, self.face, self.workers)
    }
}

/// Tosses all plans with the same random numbers.
fn count<'p>(
    plans: impl Iterator<Item = &'p Plan>,
    tosses: &Range<u64>,
    face: Face,
    workers: &Workers<'_>,
) -> Result<Vec<Seen>, QuestionError> {
    let work: Vec<_> = plans
        .map(|plan| (At { plan, point: 0 }, tosses.clone()))
        .collect();
    let counts = workers.count(&work)?;
    Ok(counts
        .into_iter()
        .map(|counts| Seen::of(counts, face))
        .collect())
}

/// All tosses of the answer; the question must have been checked.
pub(super) fn planned(question: &Aim) -> u64 {
    let places = question.parameters.iter().map(|parameter| parameter.values);
    let others = 1 + question.clumsiness.len() as u64;
    planned_search(places.product(), effort(question)) + others * question.final_tosses
}

fn effort(question: &Aim) -> Effort {
    Effort {
        first: question.tosses,
        last: question.final_tosses,
    }
}

pub(super) fn answer(
    question: &Aim,
    plans: &Plans,
    workers: &Workers<'_>,
) -> Result<Aimed, QuestionError> {
    let mut arena = Arena {
        places: &plans.places,
        face: question.face,
        workers,
    };
    let Searched {
        map,
        best,
        worst,
        last,
    } = search(&mut arena, plans.places.len(), effort(question))?;
    let (baseline, clumsy) = final_others(question, plans, best.place, &last, workers)?;
    let place = |index: usize, seen: &Seen| Place {
        values: plans.plane.at(index),
        estimate: seen.estimate(&plans.own),
    };
    let found = |found: Found| place(found.place, &found.seen);
    let own = &plans.own.points[0].engine;
    Ok(Aimed {
        question: question.clone(),
        map: map
            .iter()
            .enumerate()
            .map(|(index, seen)| place(index, seen))
            .collect(),
        best: found(best),
        worst: found(worst),
        baseline,
        clumsy,
        confidence: plans.own.confidence,
        engine: own.descriptor().name,
        law: own.law(),
        tosses: planned(question),
    })
}

/// The final tosses of the config's own launch, and of the best place in clumsier hands: with the
/// same random numbers as those of the best place, so that their differences are sharper.
fn final_others(
    question: &Aim,
    plans: &Plans,
    best: usize,
    last: &Range<u64>,
    workers: &Workers<'_>,
) -> Result<(Place, Vec<Clumsy>), QuestionError> {
    let factors = question.clumsiness.iter();
    let hands = factors
        .map(|&factor| plans.clumsy(question, best, factor))
        .collect::<Result<Vec<Plan>, _>>()?;
    let tossed = std::iter::once(&plans.own).chain(&hands);
    let seen = count(tossed, last, question.face, workers)?;
    let baseline = Place {
        values: plans.own_values.clone(),
        estimate: seen[0].estimate(&plans.own),
    };
    let clumsy = question
        .clumsiness
        .iter()
        .zip(&seen[1..])
        .map(|(&factor, seen)| Clumsy {
            factor,
            estimate: seen.estimate(&plans.own),
        });
    Ok((baseline, clumsy.collect()))
}

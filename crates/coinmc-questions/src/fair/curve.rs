//! The probability of a face along a parameter, by tosses or without.

use super::axis::Axis;
use super::known::{self, Probability};
use super::numerical;
use super::refine::{Goal, Refined};
use super::scan::{self};
use super::solve::solve;
use super::tosses::{Sample, Seen, Tosses};
use super::{Curve, Fair, Finding, Question, Root, Scanned};
use crate::interval::normal_quantile;
use crate::workers::At;
use crate::{QuestionError, Template, Workers};
use coinmc::plan::Plan;
use coinmc::run::{Count, count};
use coinmc_core::Estimate;

/// One curve: a point of the config's other parameters.
struct Along<'a> {
    template: &'a Template,
    question: &'a Question,
    workers: &'a Workers<'a>,
    point: usize,
    /// Tosses made so far.
    made: u64,
}

/// The answer, curve by curve.
pub(super) fn answer(
    template: &Template,
    question: &Question,
    axis: Axis,
    workers: &Workers<'_>,
) -> Result<Fair, QuestionError> {
    let middle = axis.ends().iter().sum::<f64>() / 2.0;
    let first = plan_at(template, question, axis.value(middle))?;
    let known = !first.makes_tosses(0);
    let mut curves = vec![];
    let mut tosses = 0;
    for (point, parameters) in first.points.iter().enumerate() {
        let value = |name: &String| {
            let found = parameters
                .parameters
                .iter()
                .find(|(known, _)| **known == **name);
            (name.clone(), found.map_or(f64::NAN, |(_, value)| *value))
        };
        let mut along = Along {
            template,
            question,
            workers,
            point,
            made: 0,
        };
        let (scan, findings) = if known {
            along.known(axis)?
        } else {
            along.tossed(axis, &first)?
        };
        tosses += along.made;
        curves.push(Curve {
            at: first.axes.iter().map(value).collect(),
            scan,
            findings,
        });
    }
    let engine = &first.points[0].engine;
    Ok(Fair {
        question: question.clone(),
        curves,
        confidence: first.confidence,
        engine: engine.descriptor().name,
        law: engine.law(),
        known,
        tosses,
    })
}

/// The plan with the parameter at a value.
pub(super) fn plan_at(
    template: &Template,
    question: &Question,
    value: f64,
) -> Result<Plan, QuestionError> {
    template.plan(&[(&question.key, format!("{value:?}"))])
}

impl Along<'_> {
    fn plan(&self, value: f64) -> Result<Plan, QuestionError> {
        plan_at(self.template, self.question, value)
    }

    fn tossed(
        &mut self,
        axis: Axis,
        first: &Plan,
    ) -> Result<(Vec<Scanned>, Vec<Finding>), QuestionError> {
        let Question {
            target,
            half_width,
            max_tosses,
            ..
        } = *self.question;
        let goal = Goal {
            target,
            half_width,
            z: normal_quantile(first.confidence),
            tosses: max_tosses,
        };
        let solved = solve(self, axis, &goal)?;
        let scanned = solved.scanned.iter().map(|scanned| {
            let Estimate { p, lo, hi, n, .. } = scanned.seen.estimate(first);
            Scanned {
                value: axis.value(scanned.u),
                p,
                lo,
                hi,
                tosses: n,
            }
        });
        let mut findings = vec![];
        for (finding, refined) in solved.findings {
            findings.push(match (finding, refined) {
                (scan::Finding::Crossing { .. }, Some(refined)) => {
                    Finding::Root(self.root(refined, &goal)?)
                }
                (
                    scan::Finding::Crossing { from, to, .. } | scan::Finding::Near { from, to },
                    _,
                ) => Finding::Near {
                    from: axis.value(from),
                    to: axis.value(to),
                },
            });
        }
        Ok((scanned.collect(), findings))
    }

    fn root(&mut self, refined: Refined, goal: &Goal) -> Result<Root, QuestionError> {
        let Refined {
            rounds,
            slope: (slope, slope_error),
            undecided,
        } = refined;
        let last = *rounds.last().expect("a search has a round");
        let value = last.value;
        let coin = self.plan(value)?.points[self.point].scene.coin;
        let mut root = Root {
            value,
            lo: last.lo,
            hi: last.hi,
            slope,
            slope_error,
            reached: last.half_width() <= goal.half_width,
            tosses: last.tosses,
            undecided,
            rounds,
            numerical: None,
            coin,
        };
        if self.question.numerical_tosses > 0 && !root.is_on_plateau() {
            root.numerical = self.numerical(&root)?;
        }
        Ok(root)
    }

    /// How far finer numerical settings would move the root.
    fn numerical(&mut self, root: &Root) -> Result<Option<numerical::Numerical>, QuestionError> {
        let usual = self.plan(root.value)?;
        let finer = numerical::finer_settings(&usual);
        if finer.is_empty() {
            return Ok(None);
        }
        let mut values = vec![(self.question.key.as_str(), format!("{:?}", root.value))];
        values.extend(
            finer
                .iter()
                .map(|(key, value)| (key.as_str(), value.clone())),
        );
        let finer = self.template.plan(&values)?;
        let tosses = self.question.numerical_tosses;
        let pair = [&usual, &finer].map(|plan| At {
            plan,
            point: self.point,
        });
        let changes = self.workers.compare(&[pair], 0..tosses)?;
        let change = changes[0].interval(self.question.face, usual.confidence);
        self.made += 2 * tosses;
        Ok(Some(numerical::Numerical::new(change, tosses, root.slope)))
    }

    fn known(&mut self, axis: Axis) -> Result<(Vec<Scanned>, Vec<Finding>), QuestionError> {
        let found = known::solve(
            &mut |value| self.probability(value),
            axis,
            self.question.target,
        )?;
        let scanned = found.scanned.iter().map(|(u, at)| Scanned {
            value: axis.value(*u),
            p: at.p,
            lo: at.lo,
            hi: at.hi,
            tosses: 0,
        });
        let root = |root: &known::KnownRoot| {
            let coin = self.plan(root.value)?.points[self.point].scene.coin;
            Ok(Finding::Root(Root {
                value: root.value,
                lo: Some(root.lo),
                hi: Some(root.hi),
                slope: root.slope,
                slope_error: 0.0,
                reached: root.hi - root.value <= self.question.half_width,
                tosses: 0,
                undecided: 0,
                rounds: vec![],
                numerical: None,
                coin,
            }))
        };
        let roots = found
            .roots
            .iter()
            .map(root)
            .collect::<Result<_, QuestionError>>()?;
        Ok((scanned.collect(), roots))
    }

    /// The face's probability where no tosses are needed.
    fn probability(&self, value: f64) -> Result<Probability, QuestionError> {
        let report = count(
            &self.plan(value)?,
            &Count {
                threads: self.workers.threads,
                cancel: self.workers.cancel,
                sink: &(),
            },
        )?;
        if report.status == coinmc::run::Status::Interrupted {
            return Err(QuestionError::Stopped);
        }
        let at = report.results.rows[self.point].estimate(self.question.face);
        Ok(Probability {
            p: at.p,
            lo: at.lo,
            hi: at.hi,
        })
    }
}

impl Tosses for Along<'_> {
    type Error = QuestionError;

    fn count(&mut self, samples: &[Sample]) -> Result<Vec<Seen>, QuestionError> {
        let plans = samples
            .iter()
            .map(|sample| self.plan(sample.value))
            .collect::<Result<Vec<_>, _>>()?;
        let work = plans.iter().zip(samples).map(|(plan, sample)| {
            let at = At {
                plan,
                point: self.point,
            };
            (at, sample.first..sample.first + sample.tosses)
        });
        let work: Vec<_> = work.collect();
        let face = self.question.face;
        let counts = self.workers.count(&work)?;
        self.made += samples.iter().map(|sample| sample.tosses).sum::<u64>();
        Ok(counts
            .into_iter()
            .map(|counts| Seen::of(counts, face))
            .collect())
    }
}

//! Profile-likelihood intervals.
//!
//! A parameter is held at a value and everything else is fitted again; the value lies within the
//! interval if twice the increase of the cost is below t², with t the two-sided quantile of
//! Student's distribution. For a linear model this is the interval value ± t·standard error. If the
//! cost does not depend on the parameter to one side (friction, if no impact slides), the interval
//! is open on that side, which linear theory cannot show.

use super::covariance::Spread;
use super::problem::{Problem, Unknown};
use super::search::elsewhere;
use crate::parameter::Parameter;

/// Optimiser steps per value.
const PATIENCE: usize = 12;
/// Values tried on one side.
const TRIES: usize = 24;
/// Accuracy of the end of an interval, relative to t.
const CLOSE: f64 = 0.005;
/// Number of random steps from which a value that seems to lie outside is tried again: the
/// optimiser cannot move between minima with different orders of impacts or with sticking and
/// sliding.
const HOPS: u64 = 6;
/// A cost that is lower than the minimum's by this is another minimum, not a rounding error.
const LOWER: f64 = 0.02;

/// The end of an interval on one side.
pub(crate) enum End<'a> {
    /// The interval ends here.
    At(f64),
    /// The interval extends to the end of the parameter's range.
    Open,
    /// A better minimum was found.
    Better(Box<Problem<'a>>),
}

/// The profile around a minimum.
pub(crate) struct Profile<'a, 'b> {
    /// The minimum.
    pub(crate) best: &'b Problem<'a>,
    /// Its standard errors and valleys.
    pub(crate) spread: &'b Spread,
    /// Two-sided quantile of Student's t.
    pub(crate) t: f64,
}

impl<'a> Profile<'a, '_> {
    /// Finds the end of the interval of the j-th unknown, a shared parameter, in one direction
    /// (±1): where twice the cost has increased by t².
    pub(crate) fn end(&self, j: usize, direction: f64) -> End<'a> {
        let Unknown::Shared(parameter) = self.best.unknowns[j] else {
            return End::Open;
        };
        let (least, value) = (self.best.cost(), self.best.value(self.best.unknowns[j]));
        let (low, high) = parameter.range();
        let scale = self.best.scale(self.best.unknowns[j]);
        let mut inside = (value, 0.0);
        let mut outside: Option<(f64, f64)> = None;
        let mut warm = self.best.clone();
        let error = self.spread.errors[j];
        let step = error.map_or(0.1 * value.abs() + 0.01 * scale, |error| self.t * error);
        let mut next = value + direction * step;
        for _ in 0..TRIES {
            next = next.clamp(low, high);
            let trial = self.held(j, parameter, next, &warm);
            let rise = trial.cost() - least;
            if rise < -LOWER {
                return End::Better(Box::new(trial));
            }
            // proportional to the distance if the model is linear
            let root = (2.0 * rise.max(0.0) / self.factor(j)).sqrt() / self.t;
            if (root - 1.0).abs() < CLOSE {
                return End::At(next);
            }
            if root < 1.0 {
                if next == low || next == high {
                    return End::Open;
                }
                inside = (next, root);
                warm = trial;
            } else {
                outside = Some((next, root));
            }
            next = match outside {
                Some(outside) => {
                    if (outside.0 - inside.0).abs() <= CLOSE * (inside.0 - value).abs() {
                        break;
                    }
                    between(inside, outside)
                }
                None => value + (inside.0 - value) * (1.2 / inside.1).clamp(1.2, 2.5),
            };
        }
        // the cost is discontinuous: the order of impacts changes
        End::At(outside.map_or(inside.0, |outside| outside.0))
    }

    fn is_inside(&self, j: usize, trial: &Problem) -> bool {
        let rise = trial.cost() - self.best.cost();
        2.0 * rise < self.t * self.t * self.factor(j)
    }

    /// Squared error relative to that from the increase of the cost.
    fn factor(&self, j: usize) -> f64 {
        self.spread.factor * self.spread.inflation[j]
    }

    /// The best fit with the parameter held, starting from the last fit inside with and without a
    /// shift along the valley.
    fn held(&self, j: usize, parameter: Parameter, at: f64, warm: &Problem<'a>) -> Problem<'a> {
        let held = warm.unknowns[j];
        let by = (at - warm.value(held)) / warm.scale(held);
        let from = |shifted: bool| {
            let mut trial = warm.clone();
            if shifted {
                trial.shift(&self.spread.valleys[j], by);
            }
            trial.point.shared = trial.point.shared.with(parameter, at);
            trial.unknowns.retain(|unknown| *unknown != held);
            let mut trial = trial.minimise(PATIENCE);
            trial.unknowns.clone_from(&warm.unknowns);
            trial
        };
        let (along, straight) = (from(true), from(false));
        let mut least = if along.cost() <= straight.cost() {
            along
        } else {
            straight
        };
        let freed = |mut trial: Problem<'a>| {
            trial.unknowns.clone_from(&warm.unknowns);
            trial
        };
        for hop in 0..self.best.tries(HOPS) {
            if self.is_inside(j, &least) {
                break;
            }
            let mut from = least.clone();
            from.unknowns.retain(|unknown| *unknown != held);
            let near = {
                let step = self.spread.draw_with_held(j, hop);
                let mut trial = least.clone();
                trial.shift(&step, 1.0);
                trial.point.shared = trial.point.shared.with(parameter, at);
                trial.unknowns.clone_from(&from.unknowns);
                trial.minimise(PATIENCE)
            };
            let far = elsewhere(&from, hop, PATIENCE);
            for trial in [Some(near), far].into_iter().flatten() {
                if trial.cost() < least.cost() {
                    least = freed(trial.minimise(PATIENCE));
                }
            }
        }
        least
    }
}

/// Where a line through two points equals 1, kept away from both ends so that a discontinuity stays
/// bracketed.
fn between(inside: (f64, f64), outside: (f64, f64)) -> f64 {
    let share = if outside.1.is_finite() {
        ((1.0 - inside.1) / (outside.1 - inside.1)).clamp(0.1, 0.9)
    } else {
        0.5
    };
    inside.0 + share * (outside.0 - inside.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::Loss;
    use crate::fit::covariance::spread;
    use crate::fit::problem::Task;
    use crate::fit::tests::{at_bounces, model};
    use crate::synthetic::Synthetic;

    /// Through (2, ½) and (4, 1½), (4, 1) lies halfway, and (−1, ¾) and (−2, 1¾) have 1 at a quarter of the way.
    #[test]
    fn the_next_value_is_where_the_line_says() {
        assert_eq!(between((2.0, 0.5), (4.0, 1.5)), 3.0);
        assert_eq!(between((-1.0, 0.75), (-2.0, 1.75)), -1.25);
        assert_eq!(between((0.0, 0.0), (8.0, 1.0)), 7.2);
    }

    /// Beyond a leap the line would come back to the same end for ever.
    #[test]
    fn the_next_value_keeps_away_from_both_ends() {
        assert_eq!(between((0.0, 0.875), (10.0, 1e6)), 1.0);
        assert_eq!(between((0.0, -1e6), (10.0, 1.0)), 9.0);
        assert_eq!(between((2.0, 0.5), (6.0, f64::INFINITY)), 4.0);
    }

    /// A profile of the restitution around the truth.
    fn profiled(test: impl Fn(&Profile, &Problem)) {
        let drops = [Synthetic::default().film(&model()).unwrap()];
        let task = Task::new(model(), &drops, Loss::Square);
        let free = [
            Parameter::Restitution,
            Parameter::Friction,
            Parameter::PulseTime,
        ];
        let best = at_bounces(&task, &free, 100).minimise(40);
        let mut spread = spread(&best).unwrap();
        spread.factor = 1.5;
        spread.inflation = vec![2.0; best.unknowns.len()];
        let profile = Profile {
            best: &best,
            spread: &spread,
            t: 2.5,
        };
        test(&profile, &best);
    }

    /// Twice the rise of the cost is compared with t² times the factors of the error: 3 t² = 18.75 here, so a rise of 9.375.
    #[test]
    fn a_value_lies_within_while_the_cost_has_risen_little() {
        profiled(|profile, best| {
            let mut at = best.clone();
            let rise = |at: &Problem| at.cost() - best.cost();
            while rise(&at) < 9.375 {
                assert!(profile.is_inside(0, &at));
                at.point.starts[0][0] += 1e-5;
            }
            assert!(rise(&at) < 10.0 && !profile.is_inside(0, &at));
        });
    }

    /// A parameter that the law does not use changes nothing, up to the end of its range.
    #[test]
    fn what_changes_nothing_has_no_end() {
        profiled(|profile, _| {
            for direction in [-1.0, 1.0] {
                assert!(matches!(profile.end(2, direction), End::Open));
                // 2.5 standard errors, of a variance that is three times as large
                let End::At(end) = profile.end(0, direction) else {
                    panic!("no end")
                };
                let error = profile.spread.errors[0].unwrap();
                let value = profile.best.point.shared.restitution;
                let arm = direction * (end - value) / (2.5 * 3.0_f64.sqrt() * error);
                assert!((arm - 1.0).abs() < 0.1, "{arm}");
            }
        });
    }

    /// The others follow a held parameter along the valley of the cost: a line on which the cost rises least.
    #[test]
    fn the_valley_is_where_the_cost_rises_least() {
        profiled(|profile, best| {
            for j in [0, 1] {
                let valley = &profile.spread.valleys[j];
                assert!((valley[j] - 1.0).abs() < 1e-12);
                let along = |direction: &[f64]| {
                    let mut moved = best.clone();
                    moved.shift(direction, 1e-4);
                    moved.cost() - best.cost()
                };
                let least = along(valley);
                for other in (0..valley.len())
                    .filter(|other| *other != j && profile.spread.errors[*other].is_some())
                {
                    for by in [-0.02, 0.02] {
                        let mut off = valley.clone();
                        off[other] += by;
                        assert!(along(&off) > least, "{j} {other} {by}");
                    }
                }
            }
            assert!(profile.spread.valleys[2].iter().all(|part| *part == 0.0));
        });
    }
}

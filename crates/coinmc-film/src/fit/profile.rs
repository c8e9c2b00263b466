//! Intervals by the profile of the likelihood.
//!
//! A parameter is held at a value, everything else is fitted again, and the value lies within the
//! interval while twice the rise of the cost stays below t², t the two-sided quantile of Student's
//! distribution. Where the model is linear this is the interval value ± t·standard error; where a
//! law is flat in a parameter (no impact slides: friction does nothing) it is open to that side,
//! as it ought to be, and linear theory could not tell.

use super::covariance::Spread;
use super::problem::{Problem, Unknown};
use super::search::elsewhere;
use crate::parameter::Parameter;

/// Steps of the optimiser at one value.
const PATIENCE: usize = 12;
/// Values tried on one side.
const TRIES: usize = 24;
/// Relative accuracy of the end of an interval, as a share of t.
const CLOSE: f64 = 0.005;
/// Random steps from which a value that seems to lie outside is tried again: between minima that
/// the order of impacts, or sticking and sliding, keeps apart the optimiser sees no way.
const HOPS: u64 = 6;
/// A cost lower than the minimum's by this is another minimum, not a rounding.
const LOWER: f64 = 0.02;

/// What a walk to one side found.
pub(crate) enum End<'a> {
    /// The interval ends here.
    At(f64),
    /// It reaches to the end of the parameter's range.
    Open,
    /// A better minimum came to light.
    Better(Box<Problem<'a>>),
}

/// What a walk needs to know of the minimum.
pub(crate) struct Around<'a, 'b> {
    /// The minimum.
    pub(crate) best: &'b Problem<'a>,
    /// Its standard errors and valleys.
    pub(crate) spread: &'b Spread,
    /// Two-sided quantile of Student's t.
    pub(crate) t: f64,
}

impl<'a> Around<'a, '_> {
    /// Walks from the minimum to one side (`direction` ±1) of the shared parameter that is the
    /// j-th unknown, until twice the cost has risen by t².
    pub(crate) fn walk(&self, j: usize, direction: f64) -> End<'a> {
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
            // proportional to the distance where the model is linear
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
        // the cost jumps: the order of impacts changes
        End::At(outside.map_or(inside.0, |outside| outside.0))
    }

    fn is_inside(&self, j: usize, trial: &Problem) -> bool {
        let rise = trial.cost() - self.best.cost();
        2.0 * rise < self.t * self.t * self.factor(j)
    }

    /// Squared error over that which the rise of the cost tells.
    fn factor(&self, j: usize) -> f64 {
        self.spread.factor * self.spread.inflation[j]
    }

    /// The best fit with the parameter held: from the last one inside, moved along the valley, and
    /// from there without that move.
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
                let mut step = self.spread.draw(hop);
                let drift = step[j];
                for (part, valley) in step.iter_mut().zip(&self.spread.valleys[j]) {
                    *part -= drift * valley;
                }
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

/// Where a straight line between two points is 1, kept off both ends so that a jump is bracketed.
fn between(inside: (f64, f64), outside: (f64, f64)) -> f64 {
    let share = if outside.1.is_finite() {
        ((1.0 - inside.1) / (outside.1 - inside.1)).clamp(0.1, 0.9)
    } else {
        0.5
    };
    inside.0 + share * (outside.0 - inside.0)
}

//! The global search for the minimum.
//!
//! The residuals are smooth functions of the parameters only while the order of impacts stays the
//! same, so a single start is not enough. The search starts on a grid of the law's parameters with
//! the states of the flight before the first impact, fits a few frames after that impact, keeps the
//! better starts, and lengthens the window step by step: later frames determine the parameters
//! better, but also create more false minima.

use super::covariance::{Spread, spread};
use super::problem::{Point, Problem, Task, Unknown, Weighing};
use crate::flight::Flight;
use crate::law::Model;
use crate::parameter::{Parameter, Shared};

/// Impacts within this many frames of each other are one bounce: the flight between them is too
/// short to distinguish them.
const TOGETHER: f64 = 4.0;
/// Optimiser steps per stage.
const PATIENCE: usize = 8;
/// Optimiser steps at the end.
const LAST_PATIENCE: usize = 40;
/// Candidates closer to each other than this, in units of the search, are the same.
const SAME: f64 = 1e-4;
/// If the residuals exceed the film's own noise by this factor, there is a better minimum or the
/// law is wrong, and a wider search is worthwhile.
const POOR: f64 = 1.15;
/// Number of random steps from a poor minimum, and their sizes in standard errors.
const FAR_STEPS: u64 = 60;
const STRIDES: [f64; 3] = [2.0, 6.0, 20.0];

/// Fractions of the frames after the first impact, along which a distant start is moved to a
/// minimum.
const STAGES: [f64; 4] = [0.1, 0.25, 0.5, 1.0];

/// Effort of a search.
struct Effort {
    /// Number of frames after the first impact in the first window.
    look: usize,
    /// Number of candidates kept after the grid.
    first: usize,
    /// Number of candidates kept to the end.
    last: usize,
    /// Factor by which the window grows per stage.
    growth: f64,
}

const EFFORTS: [Effort; 3] = [
    Effort {
        look: 8,
        first: 10,
        last: 3,
        growth: 1.6,
    },
    Effort {
        look: 4,
        first: 24,
        last: 8,
        growth: 1.3,
    },
    Effort {
        look: 12,
        first: 54,
        last: 16,
        growth: 1.15,
    },
];

/// The part of the film that counts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Window {
    /// Number of bounces.
    pub(crate) bounces: usize,
    /// Time since the first frame, s.
    pub(crate) until_s: f64,
}

/// The best minimum over all frames of the window; `None` if none is found.
pub(crate) fn search<'a>(
    task: &'a Task<'a>,
    flights: &[Flight],
    sigma: [f64; 3],
    shared: &Shared,
    free: &[Parameter],
    window: Window,
) -> Option<Problem<'a>> {
    let starts: Vec<Problem> = grid(&task.model, shared, free)
        .into_iter()
        .map(|shared| {
            let weighing = Weighing {
                frames: flights.iter().map(|flight| flight.frames).collect(),
                sigma,
            };
            let first = |flight: &Flight| {
                let mut start = flight.start;
                start[2] -= shared.floor_m;
                start
            };
            let starts = flights.iter().map(first).collect();
            Problem::new(task, weighing, free, Point { shared, starts })
        })
        .collect();
    let mut found: Vec<Problem> = Vec::new();
    // the first effort finds most minima; for costly laws the others would take hours
    let efforts = if task.model.is_costly() {
        &EFFORTS[..1]
    } else {
        &EFFORTS[..]
    };
    for effort in efforts {
        found.extend(grow(starts.clone(), flights, window, effort));
        found.sort_by(|a, b| poorness(a).total_cmp(&poorness(b)));
        if found
            .first()
            .is_some_and(|best| poorness(best) < POOR * POOR)
        {
            break;
        }
    }
    let mut minimum = search_further(found.into_iter().next()?);
    minimum.thorough &= poorness(&minimum) < POOR * POOR;
    Some(minimum)
}

/// Searches further around a minimum that leaves more than noise.
pub(super) fn search_further(mut minimum: Problem<'_>) -> Problem<'_> {
    if poorness(&minimum) < POOR * POOR {
        return minimum;
    }
    let Some(around) = spread(&minimum) else {
        return minimum;
    };
    for (number, stride) in (0..minimum.tries(FAR_STEPS)).zip(STRIDES.into_iter().cycle()) {
        let mut trial = minimum.clone();
        trial.shift(&around.draw(number), stride);
        let trial = trial.minimise(PATIENCE);
        if trial.cost() < minimum.cost() {
            minimum = trial;
        }
    }
    minimum.minimise(LAST_PATIENCE)
}

/// Searches for a distant minimum that is compatible with the frames up to soon after the first
/// impact: takes a random step within their errors (the same number gives the same step), then fits
/// windows of increasing length. A direct search over the whole window would be blocked by high
/// costs in between, because every impact amplifies the difference between two starts.
pub(super) fn elsewhere<'a>(
    from: &Problem<'a>,
    number: u64,
    patience: usize,
) -> Option<Problem<'a>> {
    let mut trial = from.clone();
    for (stage, frames) in lengths(from)?.into_iter().enumerate() {
        trial.weighing.frames = frames;
        if stage == 0 {
            let step = spread(&trial)?.draw(number);
            trial.shift(&step, 1.0);
        }
        trial = trial.minimise(patience);
    }
    Some(trial)
}

/// Linear theory for the frames up to soon after the first impact, where it still holds.
pub(super) fn early(problem: &Problem) -> Option<Spread> {
    let mut early = problem.clone();
    early.weighing.frames = lengths(problem)?.into_iter().next()?;
    spread(&early)
}

/// Number of frames of each drop at each stage.
fn lengths(problem: &Problem) -> Option<[Vec<usize>; STAGES.len()]> {
    let mut lengths = STAGES.map(|_| Vec::new());
    for (d, &all) in problem.weighing.frames.iter().enumerate() {
        let times = &problem.task.times[d];
        let path = problem.task.path(d, &problem.point, all)?;
        let first = path.impacts_s.first().copied().unwrap_or(f64::INFINITY);
        let touch = times.partition_point(|t| *t < first).min(all);
        for (share, frames) in STAGES.into_iter().zip(&mut lengths) {
            // a fraction of the existing frames
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            let more = (share * (all - touch) as f64).ceil() as usize;
            frames.push(touch + more);
        }
    }
    Some(lengths)
}

/// Mean square of the weighted residuals: 1 if the law leaves only noise.
fn poorness(problem: &Problem) -> f64 {
    let residuals = problem
        .deviations()
        .map_or(0, |deviations| deviations.len());
    2.0 * problem.cost() / residuals.max(1) as f64
}

/// From the grid to a minimum over the whole window.
fn grow<'a>(
    mut candidates: Vec<Problem<'a>>,
    flights: &[Flight],
    window: Window,
    effort: &Effort,
) -> Option<Problem<'a>> {
    let task = candidates.first()?.task;
    let all: Vec<usize> = task.drops.iter().map(|drop| drop.frames.len()).collect();
    let mut look = effort.look;
    let mut keep = effort.first;
    loop {
        let wanted: Vec<usize> = flights
            .iter()
            .zip(&all)
            .map(|(flight, all)| (flight.frames + look).min(*all))
            .collect();
        let again = candidates.first().map_or(Vec::new(), replaced);
        candidates.extend(again);
        candidates = best(candidates, &wanted, keep);
        let horizon = candidates
            .iter()
            .map(|candidate| horizon(candidate, window));
        let horizon = horizon.reduce(|a, b| a.iter().zip(&b).map(|(a, b)| *a.max(b)).collect())?;
        let frames: Vec<usize> = wanted
            .iter()
            .zip(&horizon)
            .map(|(w, h)| *w.min(h))
            .collect();
        let moved = candidates.into_iter().map(|mut candidate| {
            candidate.weighing.frames.clone_from(&frames);
            candidate.minimise(PATIENCE)
        });
        candidates = distinct(best(moved.collect(), &frames, keep));
        if frames == horizon || wanted == all {
            break;
        }
        // a growth factor above 1 adds at least one frame
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let longer = (look as f64 * effort.growth) as usize;
        look = longer.max(look + 1);
        keep = (keep * 2 / 3).max(effort.last);
    }
    candidates
        .into_iter()
        .next()
        .map(|candidate| fit_window(candidate, window))
}

/// Fits all frames of the window, whose end depends on the path, as far as the law has a
/// prediction.
fn fit_window(mut problem: Problem<'_>, window: Window) -> Problem<'_> {
    let mut frames = horizon(&problem, window);
    for _ in 0..4 {
        problem.weighing.frames.clone_from(&frames);
        problem = problem.minimise(LAST_PATIENCE);
        let valid: Vec<usize> = (0..frames.len())
            .map(|d| {
                let path = problem.task.path(d, &problem.point, frames[d]);
                path.map_or(0, |path| path.valid)
            })
            .collect();
        if valid == frames {
            break;
        }
        frames = valid;
    }
    problem
}

/// Number of frames of each drop within the window and the law's prediction.
fn horizon(problem: &Problem, window: Window) -> Vec<usize> {
    let task = problem.task;
    (0..task.drops.len())
        .map(|d| {
            let times = &task.times[d];
            let in_time = times.partition_point(|t| *t <= window.until_s);
            let Some(path) = task.path(d, &problem.point, in_time) else {
                return 0;
            };
            let step = times.last().copied().unwrap_or(0.0) / times.len() as f64;
            let end = bounce(&path.impacts_s, window.bounces, TOGETHER * step);
            let before = times.partition_point(|t| *t < end);
            in_time.min(before).min(path.valid)
        })
        .collect()
}

/// Time of bounce number `n`, from 0; infinite if there is none.
fn bounce(impacts_s: &[f64], n: usize, together_s: f64) -> f64 {
    let begins = |i: &usize| *i == 0 || impacts_s[*i] - impacts_s[*i - 1] > together_s;
    let mut bounces = (0..impacts_s.len()).filter(begins);
    bounces.nth(n).map_or(f64::INFINITY, |i| impacts_s[i])
}

/// The candidates with the lowest cost over these frames, the best first.
fn best<'a>(candidates: Vec<Problem<'a>>, frames: &[usize], keep: usize) -> Vec<Problem<'a>> {
    let mut costs: Vec<(f64, Problem)> = candidates
        .into_iter()
        .map(|mut candidate| {
            candidate.weighing.frames = frames.to_vec();
            (candidate.cost(), candidate)
        })
        .filter(|(cost, _)| cost.is_finite())
        .collect();
    // a stable sort keeps equal ones in the order of the grid
    costs.sort_by(|a, b| a.0.total_cmp(&b.0));
    costs.truncate(keep);
    costs.into_iter().map(|(_, candidate)| candidate).collect()
}

/// Removes candidates that have reached the same point as a better one.
fn distinct(candidates: Vec<Problem<'_>>) -> Vec<Problem<'_>> {
    let mut kept: Vec<Problem> = Vec::new();
    for candidate in candidates {
        let near = |other: &Problem| {
            candidate.unknowns.iter().all(|unknown| {
                let apart = candidate.value(*unknown) - other.value(*unknown);
                apart.abs() < SAME * candidate.scale(*unknown)
            })
        };
        if !kept.iter().any(near) {
            kept.push(candidate);
        }
    }
    kept
}

/// Copies of a candidate with one shared parameter replaced by each value of its grid: a later
/// impact may determine what an earlier one left open.
fn replaced<'a>(candidate: &Problem<'a>) -> Vec<Problem<'a>> {
    let mut all = Vec::new();
    for unknown in &candidate.unknowns {
        let Unknown::Shared(parameter) = unknown else {
            break;
        };
        for value in parameter.grid() {
            let mut other = candidate.clone();
            let value = value * candidate.scale(*unknown);
            other.point.shared = other.point.shared.with(*parameter, value);
            all.push(other);
        }
    }
    all
}

/// All combinations of the free parameters' grids; the others keep their values.
fn grid(model: &Model, shared: &Shared, free: &[Parameter]) -> Vec<Shared> {
    let mut points = vec![*shared];
    for parameter in free {
        if parameter.grid().is_empty() {
            continue;
        }
        let scale = parameter.scale(&model.coin, model.gravity_m_s2);
        let values = || parameter.grid().iter().map(|value| value * scale);
        points = points
            .iter()
            .flat_map(|point| values().map(|value| point.with(*parameter, value)))
            .collect();
    }
    points
}

#[cfg(test)]
mod tests;

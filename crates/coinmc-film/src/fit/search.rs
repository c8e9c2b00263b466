//! From the film to the right minimum.
//!
//! The residuals are smooth in the parameters as long as the order of impacts stays, and jump where
//! it changes: one start is not enough. So the search begins on a grid of the law's parameters with
//! the states of the flight before the first impact, looks at a few frames after that impact, keeps
//! the better starts, and lengthens the film step by step: the further an impact lies behind, the
//! more it tells of the parameters and the more minima there are that are not it.

use super::covariance::{Spread, spread};
use super::problem::{Point, Problem, Task, Unknown, Weighing};
use crate::flight::Flight;
use crate::law::Model;
use crate::parameter::{Parameter, Shared};

/// Impacts within this many frames of each other are one bounce: the flight between them is too
/// short to tell them apart.
const TOGETHER: f64 = 4.0;
/// Steps of the optimiser in a stage.
const PATIENCE: usize = 8;
/// Steps of the optimiser at the end.
const LAST_PATIENCE: usize = 40;
/// Starts nearer to each other than this, in units of the search, are one.
const SAME: f64 = 1e-4;
/// A fit whose scatter exceeds the film's own by this factor is not the best there is, or the law
/// is wrong: worth a wider search.
const POOR: f64 = 1.15;
/// Random steps from a poor minimum, and their sizes in standard errors.
const WANDER: u64 = 60;
const STRIDES: [f64; 3] = [2.0, 6.0, 20.0];

/// Shares of the frames after the first impact over which a stray start is led back to a minimum.
const STAGES: [f64; 4] = [0.1, 0.25, 0.5, 1.0];

/// How hard to look.
struct Effort {
    /// Frames after the first impact that are looked at first.
    look: usize,
    /// Starts kept after the grid.
    first: usize,
    /// Starts kept to the end.
    last: usize,
    /// By what the film grows from stage to stage.
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

/// How much of the film counts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Window {
    /// Bounces.
    pub(crate) bounces: usize,
    /// Time since the first frame, s.
    pub(crate) until_s: f64,
}

/// The best minimum found, over all frames of the window; `None` if no start leads anywhere.
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
    // the first finds most; where a path costs much the others would take hours
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
    let mut minimum = wander(found.into_iter().next()?);
    minimum.thorough &= poorness(&minimum) < POOR * POOR;
    Some(minimum)
}

/// Looks further around a minimum that leaves more than noise.
fn wander(mut minimum: Problem<'_>) -> Problem<'_> {
    if poorness(&minimum) < POOR * POOR {
        return minimum;
    }
    let Some(around) = spread(&minimum) else {
        return minimum;
    };
    for (number, stride) in (0..minimum.tries(WANDER)).zip(STRIDES.into_iter().cycle()) {
        let mut trial = minimum.clone();
        trial.shift(&around.draw(number), stride);
        let trial = trial.minimise(PATIENCE);
        if trial.cost() < minimum.cost() {
            minimum = trial;
        }
    }
    minimum.minimise(LAST_PATIENCE)
}

/// A minimum that lies elsewhere, if the film up to soon after the first impact leaves room for it:
/// a random step within that room (the same for the same number), then the film again, longer and
/// longer. Along the whole film the way there leads over mountains, for every impact multiplies
/// what sets two starts apart.
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

/// What the film tells up to soon after the first impact: where linear theory still holds.
pub(super) fn early(problem: &Problem) -> Option<Spread> {
    let mut early = problem.clone();
    early.weighing.frames = lengths(problem)?.into_iter().next()?;
    spread(&early)
}

/// Frames of each drop, at each of the stages.
fn lengths(problem: &Problem) -> Option<[Vec<usize>; STAGES.len()]> {
    let mut lengths = STAGES.map(|_| Vec::new());
    for (d, &all) in problem.weighing.frames.iter().enumerate() {
        let times = &problem.task.times[d];
        let path = problem.task.path(d, &problem.point, all)?;
        let first = path.impacts_s.first().copied().unwrap_or(f64::INFINITY);
        let touch = times.partition_point(|t| *t < first).min(all);
        for (share, frames) in STAGES.into_iter().zip(&mut lengths) {
            // a share of frames there are
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            let more = (share * (all - touch) as f64).ceil() as usize;
            frames.push(touch + more);
        }
    }
    Some(lengths)
}

/// Mean square of the weighed residuals: 1 where the law leaves nothing but noise.
fn poorness(problem: &Problem) -> f64 {
    let residuals = problem.misses().map_or(0, |misses| misses.len());
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
        // a growth beyond 1 makes at least one frame
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let longer = (look as f64 * effort.growth) as usize;
        look = longer.max(look + 1);
        keep = (keep * 2 / 3).max(effort.last);
    }
    candidates
        .into_iter()
        .next()
        .map(|candidate| settle(candidate, window))
}

/// Fits all frames of the window: it ends where the path says that led there, and before anything
/// of which the law says nothing.
fn settle(mut problem: Problem<'_>, window: Window) -> Problem<'_> {
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

/// Frames of each drop that lie in the window and in what the law can predict.
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

/// When the bounce number `n`, from 0, begins; infinite if there is none.
fn bounce(impacts_s: &[f64], n: usize, together_s: f64) -> f64 {
    let begins = |i: &usize| *i == 0 || impacts_s[*i] - impacts_s[*i - 1] > together_s;
    let mut bounces = (0..impacts_s.len()).filter(begins);
    bounces.nth(n).map_or(f64::INFINITY, |i| impacts_s[i])
}

/// Those with the lowest cost over these frames, the best first.
fn best<'a>(candidates: Vec<Problem<'a>>, frames: &[usize], keep: usize) -> Vec<Problem<'a>> {
    let mut costs: Vec<(f64, Problem)> = candidates
        .into_iter()
        .map(|mut candidate| {
            candidate.weighing.frames = frames.to_vec();
            (candidate.cost(), candidate)
        })
        .filter(|(cost, _)| cost.is_finite())
        .collect();
    // stable: equals stay in the order of the grid
    costs.sort_by(|a, b| a.0.total_cmp(&b.0));
    costs.truncate(keep);
    costs.into_iter().map(|(_, candidate)| candidate).collect()
}

/// Without those that have come to the same place as a better one.
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

/// A candidate with each shared parameter in turn at each value of its grid: what an early impact
/// left open the next one may tell.
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

/// Every combination of the free parameters' grids; the others stay.
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

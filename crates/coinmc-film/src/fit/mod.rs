//! Fitting a law to drops.
//!
//! ```text
//! drops ─▶ flight, noise ─▶ grid, growing window ─▶ minimum ⇄ σ of each coordinate
//!                                                      └─▶ intervals, criteria, residuals
//! ```
//! Every drop has its own initial state; the law's parameters are shared. x, z and θ each have their
//! own noise σ, which is estimated too: the residuals are weighted by it and fitted again until it
//! converges.

mod covariance;
mod error;
mod loss;
mod problem;
mod profile;
mod remark;
mod result;
mod search;

pub use error::FitError;
pub use loss::Loss;
pub use remark::Remark;
pub use result::{Estimated, Fit, FittedDrop, Noise, Residual};

use crate::drop::{FilmedDrop, MAX_FRAMES};
use crate::flight::{Flight, MIN_FLIGHT, flight, noise};
use crate::law::Model;
use crate::parameter::{Parameter, Shared, parameters};
use coinmc_core::student_t_quantile;
use covariance::{Spread, scales, spread};
use problem::{Problem, Task};
use profile::{End, Profile};
use search::{Window, elsewhere, search};

/// Greatest number of drops of a fit.
pub const MAX_DROPS: usize = 64;
/// Greatest number of elements in the Jacobian.
const MAX_CELLS: usize = 40_000_000;
/// Greatest number of rounds of estimating σ and repeating the fit.
const ROUNDS: usize = 6;
/// Relative change of σ below which it has converged.
const CONVERGED: f64 = 1e-4;
/// Number of random steps around a minimum, and their size in standard errors.
const HOPS: u64 = 16;
const HOP: f64 = 1.5;
/// Number of searches for distant minima along a growing window, and optimiser steps per length.
const ELSEWHERE: u64 = 12;
const PATIENCE: usize = 12;
/// Greatest number of better minima found while computing intervals.
const RESTARTS: usize = 5;

/// Options of a fit.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Parameters to fit, if the law has them; the others keep their value in `shared` or in the
    /// law.
    pub free: Vec<Parameter>,
    /// Values of the parameters that are not fitted. A law's own parameters are those of its model.
    pub shared: Shared,
    /// Number of bounces to fit: frames count up to the next bounce after these. Impacts within
    /// four frames of each other are one bounce.
    pub bounces: usize,
    /// Greatest time since the first frame to fit, s.
    pub until_s: f64,
    /// Loss of the residuals.
    pub loss: Loss,
    /// Confidence of every interval, in (0, 1).
    pub confidence: f64,
}

impl Default for Options {
    /// Restitution, friction and η from the first two bounces, with normal noise and 95 %
    /// confidence.
    fn default() -> Self {
        Self {
            free: vec![Parameter::Restitution, Parameter::Friction, Parameter::Eta],
            shared: Shared::default(),
            bounces: 2,
            until_s: f64::INFINITY,
            loss: Loss::Square,
            confidence: 0.95,
        }
    }
}

/// Fits one law to drops.
///
/// # Errors
/// [`FitError`] if the drops do not allow a fit or none is found.
///
/// # Example
/// ```
/// use coinmc_core::Coin;
/// use coinmc_film::{Law, Model, Options, Parameter, Synthetic, fit};
/// let model = Model {
///     law: Law::Moreau,
///     coin: Coin::cylinder(1.0, 0.01)?,
///     gravity_m_s2: 9.81,
/// };
/// let drop = Synthetic { seed: 3, ..Synthetic::default() }.film(&model).unwrap();
/// let fit = fit(&model, &[drop], &Options::default())?;
/// let e = fit.estimate(Parameter::Restitution).unwrap();
/// println!("e = {:.3}, {:?} to {:?}", e.value, e.lo, e.hi);
/// assert!((e.value - 0.5).abs() < 0.02);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn fit(model: &Model, drops: &[FilmedDrop], options: &Options) -> Result<Fit, FitError> {
    Ok(fit_all(&[*model], drops, options)?.remove(0))
}

/// Fits several laws to the same frames of the same drops, so that they can be compared: only
/// frames for which every law has a prediction count.
///
/// # Errors
/// [`FitError`] if the drops do not allow a fit or none is found for a law.
pub fn fit_all(
    models: &[Model],
    drops: &[FilmedDrop],
    options: &Options,
) -> Result<Vec<Fit>, FitError> {
    let tasks: Vec<Task> = models
        .iter()
        .map(|model| Task::new(*model, drops, options.loss))
        .collect();
    let sigma = noise(drops);
    let window = Window {
        bounces: options.bounces,
        until_s: options.until_s,
    };
    let mut minima = Vec::new();
    for task in &tasks {
        check(task, options)?;
        let flights = flights(task, &sigma)?;
        let law = task.model.law;
        let found = search(
            task,
            &flights,
            sigma,
            &options.shared.of(law),
            &free(task, options),
            window,
        );
        minima.push(found.ok_or(FitError::NothingFound { law: law.name() })?);
    }
    let shortest = (0..drops.len())
        .map(|d| {
            minima
                .iter()
                .map(|m| m.weighing.frames[d])
                .min()
                .unwrap_or(0)
        })
        .collect::<Vec<_>>();
    for minimum in &mut minima {
        minimum.weighing.frames.clone_from(&shortest);
    }
    for minimum in &minima {
        check_points(minimum)?;
    }
    minima
        .into_iter()
        .map(|minimum| finish(minimum, options).ok_or(FitError::Lost))
        .collect()
}

fn free(task: &Task, options: &Options) -> Vec<Parameter> {
    let known = parameters(task.model.law);
    let wanted = Parameter::ALL
        .into_iter()
        .filter(|p| options.free.contains(p));
    wanted.filter(|p| known.contains(p)).collect()
}

fn check(task: &Task, options: &Options) -> Result<(), FitError> {
    let drops = task.drops;
    if drops.is_empty() || drops.len() > MAX_DROPS {
        return Err(FitError::Drops(drops.len()));
    }
    if !(options.confidence > 0.0 && options.confidence < 1.0) {
        return Err(FitError::Confidence(options.confidence));
    }
    if options.shared != options.shared.clamped() {
        return Err(FitError::OutOfRange);
    }
    for drop in drops {
        let frames = drop.frames.len();
        if frames > MAX_FRAMES {
            let (name, max) = (drop.name.clone(), MAX_FRAMES);
            return Err(FitError::TooLong { name, frames, max });
        }
    }
    let frames: usize = drops.iter().map(|drop| drop.frames.len()).sum();
    let cells = 3 * frames * (6 * drops.len() + options.free.len());
    if cells > MAX_CELLS {
        return Err(FitError::TooLarge { frames });
    }
    Ok(())
}

/// Whether more points count than values are fitted: else any law fits them, and none can be told from another.
fn check_points(minimum: &Problem) -> Result<(), FitError> {
    let points = minimum.deviations().ok_or(FitError::Lost)?;
    let fitted = result::fitted(minimum, &points);
    match points.len() {
        many if many > fitted => Ok(()),
        points => Err(FitError::TooFew { points, fitted }),
    }
}

fn flights(task: &Task, noise: &[f64; 3]) -> Result<Vec<Flight>, FitError> {
    let found = task.drops.iter().map(|drop| {
        flight(drop, task.model.gravity_m_s2, noise).ok_or_else(|| FitError::NoFlight {
            name: drop.name.clone(),
            least: MIN_FLIGHT,
        })
    });
    found.collect()
}

/// Computes σ, intervals and everything else that is reported; `None` if the computation fails.
fn finish(mut minimum: Problem<'_>, options: &Options) -> Option<Fit> {
    for restart in 0.. {
        let (settled, around) = converge_noise(hop(minimum)?)?;
        match intervals(&settled, &around, options, restart < RESTARTS) {
            Ok(ends) => return result::report(&settled, &around, &ends, options),
            Err(better) => minimum = better.minimise(40),
        }
    }
    None
}

/// Looks for a better minimum nearby, by random steps of the size of the errors, and wherever the
/// frames up to the first impact allow one.
fn hop(mut minimum: Problem<'_>) -> Option<Problem<'_>> {
    let around = spread(&minimum)?;
    for number in 0..minimum.tries(HOPS) {
        let mut trial = minimum.clone();
        trial.shift(&around.draw(number), HOP);
        let trial = trial.minimise(40);
        if trial.cost() < minimum.cost() {
            minimum = trial;
        }
    }
    for number in 0..minimum.tries(ELSEWHERE) {
        if let Some(trial) = elsewhere(&minimum, number, PATIENCE)
            && trial.cost() < minimum.cost()
        {
            minimum = trial.minimise(40);
        }
    }
    Some(minimum)
}

/// Weights the residuals by their own noise until it converges.
fn converge_noise(mut minimum: Problem<'_>) -> Option<(Problem<'_>, Spread)> {
    let mut around = spread(&minimum)?;
    for _ in 0..ROUNDS {
        let sigma = scales(&minimum, &around.taken)?;
        let stays = sigma
            .iter()
            .zip(&minimum.weighing.sigma)
            .all(|(now, before)| (now / before - 1.0).abs() < CONVERGED);
        minimum.weighing.sigma = sigma;
        minimum = minimum.minimise(40);
        around = spread(&minimum)?;
        if stays {
            break;
        }
    }
    Some((minimum, around))
}

/// Ends of the interval of each shared parameter in the order of the unknowns; `None`: open.
type Ends = Vec<(Option<f64>, Option<f64>)>;

fn intervals<'a>(
    minimum: &Problem<'a>,
    spread: &Spread,
    options: &Options,
    may_restart: bool,
) -> Result<Ends, Box<Problem<'a>>> {
    let around = Profile {
        best: minimum,
        spread,
        t: student_t_quantile(spread.degrees(), 0.5 * (1.0 - options.confidence)),
    };
    let mut ends = Vec::new();
    for j in 0..spread.valleys.len() {
        let mut sides = [None, None];
        for (side, direction) in sides.iter_mut().zip([-1.0, 1.0]) {
            match around.end(j, direction) {
                End::At(value) => *side = Some(value),
                End::Better(better) if may_restart => return Err(better),
                // open, or there is no stable minimum: no end can be stated
                End::Open | End::Better(_) => {}
            }
        }
        ends.push((sides[0], sides[1]));
    }
    Ok(ends)
}

#[cfg(test)]
pub(crate) mod tests;

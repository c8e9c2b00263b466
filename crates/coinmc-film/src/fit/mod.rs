//! Fitting a law to drops.
//!
//! ```text
//! drops ─▶ flight, noise ─▶ grid and growing film ─▶ minimum ⇄ σ of each coordinate
//!                                                      └─▶ intervals, criteria, residuals
//! ```
//! Every drop has its own first state; the law's parameters are shared. x, z and θ each have their
//! own noise, which is estimated along: the residuals are weighed by it, fitted again, and so on
//! until it stays.

mod covariance;
mod error;
mod loss;
mod problem;
mod profile;
mod remark;
mod result;
mod search;
mod student;

pub use error::FitError;
pub use loss::Loss;
pub use remark::Remark;
pub use result::{Estimated, Fit, FittedDrop, Noise, Residual};

use crate::drop::{FilmedDrop, MAX_FRAMES};
use crate::flight::{Flight, LEAST_FLIGHT, flight, noise};
use crate::law::Model;
use crate::parameter::{Parameter, Shared, parameters};
use covariance::{Spread, scales, spread};
use problem::{Problem, Task};
use profile::{Around, End};
use search::{Window, elsewhere, search};

/// Most drops of a fit.
pub const MAX_DROPS: usize = 64;
/// Most numbers in the matrix of derivatives.
const MAX_CELLS: usize = 40_000_000;
/// Rounds in which σ is estimated and the fit repeated.
const ROUNDS: usize = 6;
/// σ that changes by less than this share stays.
const STAYS: f64 = 1e-4;
/// Random steps about a minimum, and their size in standard errors.
const HOPS: u64 = 16;
const HOP: f64 = 1.5;
/// Searches elsewhere, led back along a growing film, and steps of the optimiser at each length.
const ELSEWHERE: u64 = 12;
const PATIENCE: usize = 12;
/// How often a better minimum may be found while intervals are made.
const RESTARTS: usize = 5;

/// What a fit is asked to do.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Parameters to fit, as far as a law has them; the others keep their value of `shared`, or
    /// of the law.
    pub free: Vec<Parameter>,
    /// Values of the parameters that are not fitted. A law's own numbers are those of its model.
    pub shared: Shared,
    /// The film counts up to the bounce after this many. Impacts within four frames of each other
    /// are one bounce.
    pub bounces: usize,
    /// And no longer than this after its first frame, s.
    pub until_s: f64,
    /// What residuals cost.
    pub loss: Loss,
    /// Of every interval, in (0, 1).
    pub confidence: f64,
}

impl Default for Options {
    /// Restitution, friction and η from the first two bounces, normal noise, 95 %.
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
/// [`FitError`] if the drops do not allow a fit, or none is found.
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

/// Fits several laws to the same frames of the same drops, so that they can be compared: frames
/// count as long as every law has something to say of them.
///
/// # Errors
/// [`FitError`] if the drops do not allow a fit, or none is found for a law.
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
            let (name, most) = (drop.name.clone(), MAX_FRAMES);
            return Err(FitError::TooLong { name, frames, most });
        }
    }
    let frames: usize = drops.iter().map(|drop| drop.frames.len()).sum();
    let cells = 3 * frames * (6 * drops.len() + options.free.len());
    if cells > MAX_CELLS {
        return Err(FitError::TooLarge { frames });
    }
    Ok(())
}

fn flights(task: &Task, noise: &[f64; 3]) -> Result<Vec<Flight>, FitError> {
    let found = task.drops.iter().map(|drop| {
        flight(drop, task.model.gravity_m_s2, noise).ok_or_else(|| FitError::NoFlight {
            name: drop.name.clone(),
            least: LEAST_FLIGHT,
        })
    });
    found.collect()
}

/// σ, intervals and all else that is reported; `None` if the numbers went wrong.
fn finish(mut minimum: Problem<'_>, options: &Options) -> Option<Fit> {
    for restart in 0.. {
        let (settled, around) = settle_noise(hop(minimum)?)?;
        match intervals(&settled, &around, options, restart < RESTARTS) {
            Ok(ends) => return result::report(&settled, &around, &ends, options),
            Err(better) => minimum = better.minimise(40),
        }
    }
    None
}

/// Looks for a better minimum near by, by random steps as large as the errors, and where the first
/// impact leaves room for one.
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

/// Weighs the residuals by their own scatter until that stays.
fn settle_noise(mut minimum: Problem<'_>) -> Option<(Problem<'_>, Spread)> {
    let mut around = spread(&minimum)?;
    for _ in 0..ROUNDS {
        let sigma = scales(&minimum, &around.taken)?;
        let stays = sigma
            .iter()
            .zip(&minimum.weighing.sigma)
            .all(|(now, before)| (now / before - 1.0).abs() < STAYS);
        minimum.weighing.sigma = sigma;
        minimum = minimum.minimise(40);
        around = spread(&minimum)?;
        if stays {
            break;
        }
    }
    Some((minimum, around))
}

/// The interval of each shared parameter in the order of the unknowns: its ends, open where `None`.
type Ends = Vec<(Option<f64>, Option<f64>)>;

fn intervals<'a>(
    minimum: &Problem<'a>,
    spread: &Spread,
    options: &Options,
    may_restart: bool,
) -> Result<Ends, Box<Problem<'a>>> {
    let around = Around {
        best: minimum,
        spread,
        t: student::quantile(options.confidence, spread.degrees()),
    };
    let mut ends = Vec::new();
    for j in 0..spread.valleys.len() {
        let mut sides = [None, None];
        for (side, direction) in sides.iter_mut().zip([-1.0, 1.0]) {
            match around.walk(j, direction) {
                End::At(value) => *side = Some(value),
                End::Better(better) if may_restart => return Err(better),
                // open, or the minimum is not to be had: no end can be stated
                End::Open | End::Better(_) => {}
            }
        }
        ends.push((sides[0], sides[1]));
    }
    Ok(ends)
}

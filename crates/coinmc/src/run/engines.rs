//! From an engine's name to its code: the one place that knows all engines.
//!
//! A new engine is a variant of [`EngineChoice`] and an arm in each `match` here.

use crate::plan::{EngineChoice, Plan, Point};
use coinmc_core::{Domain, Ended, Engine, Face, Launch, Outcome, Stream};
use coinmc_flat::AnyFlatEngine;
use coinmc_rapier::RapierEngine;
use coinmc_volumetric::AnyVolumetricEngine;
use thiserror::Error;

/// An engine refuses its settings.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum SettingsError {
    /// The flat engine.
    #[error(transparent)]
    Flat(#[from] coinmc_flat::SettingsError),
    /// The volumetric engine.
    #[error(transparent)]
    Volumetric(#[from] coinmc_volumetric::SettingsError),
    /// Rapier.
    #[error(transparent)]
    Rapier(#[from] coinmc_rapier::SettingsError),
}

/// The engine's name in results.
pub fn name(choice: &EngineChoice) -> &'static str {
    match choice {
        EngineChoice::Flat(_) => "flat",
        EngineChoice::Volumetric(_) => "volumetric",
        EngineChoice::Rapier(_) => "rapier",
        EngineChoice::Analytic(_) => "analytic",
    }
}

/// The name in results of the law it follows: of impact, or the closed form's.
pub(crate) fn law(choice: &EngineChoice) -> &'static str {
    match choice {
        EngineChoice::Flat(settings) => settings.law.name(),
        EngineChoice::Volumetric(settings) => settings.law.name(),
        // Rapier has one law of impact; how it solves friction is what can be chosen
        EngineChoice::Rapier(settings) => settings.friction_model.name(),
        EngineChoice::Analytic(rule) => rule.name(),
    }
}

/// What is done with an engine, compiled for each of them.
pub(crate) trait Task {
    /// What comes of it.
    type Output;

    /// Does it.
    fn with<E: Engine>(self, engine: &E) -> Self::Output;
}

/// Does a task with the engine of a point; `None` for a closed form, which makes no tosses.
pub(crate) fn with_engine<T: Task>(
    point: &Point,
    task: T,
) -> Result<Option<T::Output>, SettingsError> {
    let scene = &point.scene;
    Ok(Some(match point.engine {
        EngineChoice::Flat(settings) => task.with(&AnyFlatEngine::new(scene, &settings)?),
        EngineChoice::Volumetric(settings) => {
            task.with(&AnyVolumetricEngine::new(scene, &settings)?)
        }
        EngineChoice::Rapier(settings) => task.with(&RapierEngine::new(scene, &settings)?),
        EngineChoice::Analytic(_) => return Ok(None),
    }))
}

/// Follows one launch at a point, for who has launches of their own; a closed form makes no toss
/// and gives what counts as none, [`Ended::Failed`].
///
/// # Errors
/// [`SettingsError`] if the engine refuses its settings.
pub fn toss(point: &Point, launch: &Launch) -> Result<Outcome, SettingsError> {
    struct Toss<'a>(&'a Launch);
    impl Task for Toss<'_> {
        type Output = Outcome;

        fn with<E: Engine>(self, engine: &E) -> Outcome {
            engine.toss(&mut engine.workspace(), self.0, &mut ())
        }
    }
    Ok(with_engine(point, Toss(launch))?.unwrap_or(Outcome {
        ended: Ended::Failed,
        ..Outcome::decided(Face::Side)
    }))
}

/// The random numbers of the launches of point `point`.
pub fn stream(plan: &Plan, point: usize) -> Stream {
    let point = if plan.paired { 0 } else { point as u64 };
    Stream::new(plan.seed, Domain::Launch, point)
}

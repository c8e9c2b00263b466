//! From an engine's name to its code: the one place that knows all engines.
//!
//! A new engine is a variant of [`EngineChoice`] and an arm in each `match` here. What an engine is
//! made of (its law) is matched here too, once a [`Task`], so that the loop over tosses is compiled
//! for it.

use crate::plan::{EngineChoice, Plan, Point};
use coinmc_core::{Domain, Ended, Engine, Face, Launch, Outcome, Stream, Tally};
use coinmc_flat::AnyFlatEngine;
use coinmc_rapier::RapierEngine;
use coinmc_volumetric::AnyVolumetricEngine;
use std::ops::{ControlFlow, Range};
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

/// Tosses between two questions whether to go on: about 0.1 ms of typical tosses in the plane and
/// 1 ms in space, so that asking costs nothing, and well under 0.1 s of the most tedious ones.
const BATCH: u64 = 64;

/// The same of tosses in time steps: one takes from 1 ms to seconds.
const STEPPED_BATCH: u64 = 1;

/// The engine's name in results.
pub(crate) fn name(choice: &EngineChoice) -> &'static str {
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
        EngineChoice::Flat(settings) => match AnyFlatEngine::new(scene, &settings)? {
            AnyFlatEngine::Moreau(engine) => task.with(&engine),
            AnyFlatEngine::ChatterjeeRuina(engine) => task.with(&engine),
            AnyFlatEngine::Paper(engine) => task.with(&engine),
            AnyFlatEngine::HalfSine(engine) => task.with(&engine),
            AnyFlatEngine::LineContact(engine) => task.with(&engine),
        },
        EngineChoice::Volumetric(settings) => match AnyVolumetricEngine::new(scene, &settings)? {
            AnyVolumetricEngine::Moreau(engine) => task.with(&engine),
            AnyVolumetricEngine::ChatterjeeRuina(engine) => task.with(&engine),
            AnyVolumetricEngine::Stronge(engine) => task.with(&engine),
        },
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

/// Tallies a range of tosses of one point, asking `go_on` every now and then; `None` if it said
/// no.
pub(super) fn tally(
    plan: &Plan,
    point: usize,
    tosses: Range<u64>,
    go_on: impl Fn() -> bool,
) -> Result<Option<Tally>, SettingsError> {
    let count = Count {
        point: &plan.points[point],
        stream: stream(plan, point),
        tosses,
        go_on,
    };
    Ok(with_engine(&plan.points[point], count)?.unwrap_or(Some(Tally::default())))
}

/// Tosses to be tallied.
struct Count<'a, F> {
    point: &'a Point,
    stream: Stream,
    tosses: Range<u64>,
    go_on: F,
}

impl<F: Fn() -> bool> Task for Count<'_, F> {
    type Output = Option<Tally>;

    fn with<E: Engine>(self, engine: &E) -> Option<Tally> {
        let Point {
            scene, launches, ..
        } = self.point;
        let wanted = self.tosses.end.saturating_sub(self.tosses.start);
        let batch = match self.point.engine {
            EngineChoice::Rapier(_) => STEPPED_BATCH,
            _ => BATCH,
        };
        let launch = |toss| launches.launch(&scene.coin, &mut self.stream.toss(toss));
        let mut tally = Tally::default();
        if (self.go_on)() {
            let tosses = self.tosses.map(launch);
            engine.toss_all(&mut engine.workspace(), tosses, |_, outcome| {
                tally.add(outcome);
                if tally.tosses() % batch == 0 && !(self.go_on)() {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            });
        }
        (tally.tosses() == wanted).then_some(tally)
    }
}

//! From an engine's name to its code: the one place that knows all engines.
//!
//! A new engine is a variant of [`EngineChoice`] and an arm in each `match` here. What an engine is
//! made of (its law) is matched here too, once a shard, so that the loop over tosses is compiled
//! for it.

use crate::plan::{EngineChoice, Plan};
use coinmc_core::{Domain, Engine, Stream, Tally, run_tosses};
use coinmc_flat::AnyFlatEngine;
use coinmc_volumetric::AnyVolumetricEngine;
use std::ops::Range;
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
}

/// Tosses between two questions whether to go on: about 0.1 ms of typical tosses in the plane and
/// 1 ms in space, so that asking costs nothing, and well under 0.1 s of the most tedious ones.
const BATCH: u64 = 64;

/// The engine's name in results.
pub(crate) fn name(choice: &EngineChoice) -> &'static str {
    match choice {
        EngineChoice::Flat(_) => "flat",
        EngineChoice::Volumetric(_) => "volumetric",
        EngineChoice::Analytic(_) => "analytic",
    }
}

/// The name in results of the law it follows: of impact, or the closed form's.
pub(crate) fn law(choice: &EngineChoice) -> &'static str {
    match choice {
        EngineChoice::Flat(settings) => settings.law.name(),
        EngineChoice::Volumetric(settings) => settings.law.name(),
        EngineChoice::Analytic(rule) => rule.name(),
    }
}

/// Tallies a range of tosses of one point, asking `go_on` every now and then; `None` if it said
/// no.
pub(super) fn tally(
    plan: &Plan,
    point: usize,
    tosses: Range<u64>,
    go_on: impl Fn() -> bool,
) -> Result<Option<Tally>, SettingsError> {
    let scene = &plan.points[point].scene;
    Ok(match plan.points[point].engine {
        EngineChoice::Flat(settings) => match AnyFlatEngine::new(scene, &settings)? {
            AnyFlatEngine::Moreau(engine) => follow(&engine, plan, point, tosses, go_on),
            AnyFlatEngine::ChatterjeeRuina(engine) => follow(&engine, plan, point, tosses, go_on),
            AnyFlatEngine::Paper(engine) => follow(&engine, plan, point, tosses, go_on),
            AnyFlatEngine::HalfSine(engine) => follow(&engine, plan, point, tosses, go_on),
            AnyFlatEngine::LineContact(engine) => follow(&engine, plan, point, tosses, go_on),
        },
        EngineChoice::Volumetric(settings) => match AnyVolumetricEngine::new(scene, &settings)? {
            AnyVolumetricEngine::Moreau(engine) => follow(&engine, plan, point, tosses, go_on),
            AnyVolumetricEngine::ChatterjeeRuina(engine) => {
                follow(&engine, plan, point, tosses, go_on)
            }
            AnyVolumetricEngine::Stronge(engine) => follow(&engine, plan, point, tosses, go_on),
        },
        EngineChoice::Analytic(_) => Some(Tally::default()),
    })
}

fn follow<E: Engine>(
    engine: &E,
    plan: &Plan,
    index: usize,
    tosses: Range<u64>,
    go_on: impl Fn() -> bool,
) -> Option<Tally> {
    let point = &plan.points[index];
    let stream = Stream::new(
        plan.seed,
        Domain::Launch,
        if plan.paired { 0 } else { index as u64 },
    );
    let mut workspace = engine.workspace();
    let mut tally = Tally::default();
    let mut start = tosses.start;
    while start < tosses.end {
        if !go_on() {
            return None;
        }
        let end = tosses.end.min(start.saturating_add(BATCH));
        let (scene, launches) = (&point.scene, &point.launches);
        tally.merge(&run_tosses(
            engine,
            &mut workspace,
            scene,
            launches,
            &stream,
            start..end,
        ));
        start = end;
    }
    Some(tally)
}

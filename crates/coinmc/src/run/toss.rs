//! A single toss, and the random numbers of all tosses.

use crate::plan::{Plan, Point};
use coinmc_core::{Domain, Ended, Engine, EngineError, Face, Launch, Outcome, Stream};

/// Computes the toss of a given launch at a point. A point with a closed form makes no toss: then
/// the outcome is [`Ended::Failed`].
///
/// # Errors
/// [`EngineError`] if the engine rejects its settings.
pub fn toss(point: &Point, launch: &Launch) -> Result<Outcome, EngineError> {
    Ok(match point.build_engine()? {
        Some(engine) => engine.toss(&mut (), launch, &mut ()),
        None => Outcome {
            ended: Ended::Failed,
            ..Outcome::decided(Face::Side)
        },
    })
}

/// The random numbers of the launches of point `point`.
pub fn stream(plan: &Plan, point: usize) -> Stream {
    let point = if plan.paired { 0 } else { point as u64 };
    Stream::new(plan.seed, Domain::Launch, point)
}

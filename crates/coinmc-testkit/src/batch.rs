//! An engine's tosses one at a time and in a batch.

use coinmc_core::{Engine, Launch, Outcome};
use std::ops::ControlFlow;

/// Every toss on the scalar path, in the order of the launches.
pub fn scalar_outcomes<E: Engine>(engine: &E, launches: &[Launch]) -> Vec<Outcome> {
    let mut workspace = engine.workspace();
    let toss = |launch| engine.toss(&mut workspace, launch, &mut ());
    launches.iter().map(toss).collect()
}

/// Every toss of one batch, in the order of the launches.
///
/// # Panics
/// If the engine reports a toss twice or not at all.
pub fn batch_outcomes<E: Engine>(engine: &E, launches: &[Launch]) -> Vec<Outcome> {
    let mut outcomes = vec![None; launches.len()];
    let launches = launches.iter().copied();
    engine.toss_all(&mut engine.workspace(), launches, |number, outcome| {
        let index = usize::try_from(number).expect("a small number");
        let earlier = outcomes[index].replace(*outcome);
        assert!(earlier.is_none(), "toss {number} is reported twice");
        ControlFlow::Continue(())
    });
    let outcomes: Option<Vec<Outcome>> = outcomes.into_iter().collect();
    outcomes.expect("every toss ends")
}

/// How many tosses a batch reports to a caller who stops it after `enough`.
pub fn count_until<E: Engine>(
    engine: &E,
    workspace: &mut E::Workspace,
    launches: impl Iterator<Item = Launch>,
    enough: u64,
) -> u64 {
    let mut reported = 0;
    engine.toss_all(workspace, launches, |_, _| {
        reported += 1;
        if reported == enough {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    });
    reported
}

//! What the integrals of a plan will cost.

use coinmc::plan::{Integral, Plan};
use coinmc::run::{RunError, integrate_point};
use std::time::Instant;

/// Evaluations of a trial: some 10 ms.
const TRIAL: u64 = 1 << 12;
/// By how much the interval shortens when the evaluations double: by half or more where little is
/// random, by a quarter where much is.
const SHORTENS: f64 = 0.6;

/// The time of a point's integral on one thread.
pub(super) fn seconds(plan: &Plan, point: usize) -> Result<f64, RunError> {
    let start = Instant::now();
    let found = integrate_point(plan, point, TRIAL)?;
    let trial = start.elapsed().as_secs_f64();
    Ok(found.map_or(0.0, |found| trial * longer(plan, &found)))
}

/// How many times as long as the trial a point will take.
fn longer(plan: &Plan, trial: &Integral) -> f64 {
    let goal = plan.goal();
    let (mut width, mut times) = (trial.half_width(), 1.0);
    let trial = trial.evaluations as f64;
    while width > goal.half_width && trial * times * 2.0 <= goal.evaluations as f64 {
        width *= SHORTENS;
        times *= 2.0;
    }
    times
}

//! What the integrals of a plan will cost.

use super::clock::Clock;
use coinmc::plan::Plan;
use coinmc::run::{RunError, integrate_point};

/// Evaluations of the first trial, some 10 ms, and of the second.
const TRIALS: [u64; 2] = [1 << 12, 1 << 14];

/// The time of a point's integral on one thread.
pub(super) fn seconds(plan: &Plan, point: usize) -> Result<f64, RunError> {
    let (goal, most) = (plan.goal().half_width, plan.goal().evaluations);
    let mut trials = Vec::new();
    for evaluations in TRIALS {
        let start = Clock::now();
        let Some(found) = integrate_point(plan, point, evaluations)? else {
            return Ok(0.0);
        };
        let trial = Trial {
            evaluations: found.evaluations as f64,
            half_width: found.half_width(),
            seconds: start.elapsed().as_secs_f64(),
        };
        let is_whole = found.evaluations < evaluations || most <= evaluations;
        if is_whole || trial.half_width <= goal {
            return Ok(trial.seconds);
        }
        trials.push(trial);
    }
    let evaluations = needed(&trials[0], &trials[1], goal);
    let wanted = evaluations.min(most as f64) / trials[1].evaluations;
    Ok(trials[1].seconds * wanted.max(1.0))
}

/// What an integral with so many evaluations came to.
#[derive(Debug, Clone, Copy)]
struct Trial {
    evaluations: f64,
    half_width: f64,
    seconds: f64,
}

/// Evaluations until the interval is short enough: a power of two times those of the last trial, as
/// an integral doubles them, while the interval goes on to shorten as it did from one trial to the
/// other. (By the square root of the evaluations at least, by their number at most: a pair of
/// intervals is chance in part.)
fn needed(first: &Trial, last: &Trial, goal: f64) -> f64 {
    let shorter = libm::log2(first.half_width / last.half_width);
    let more = libm::log2(last.evaluations / first.evaluations);
    let order = (shorter / more).clamp(0.5, 1.0);
    let doublings = (libm::log2(last.half_width / goal) / order).ceil();
    last.evaluations * libm::exp2(doublings.max(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_go_on_as_they_began() {
        let trial = |evaluations, half_width| Trial {
            evaluations,
            half_width,
            seconds: 0.0,
        };
        let needed = |second| needed(&trial(1000.0, 0.01), &trial(4000.0, second), 0.001);
        // as the square root: 0.005 to 0.001 takes 25 times as many, 32 as they double
        assert_eq!(needed(0.005), 32.0 * 4000.0);
        // no better than their number, no worse than its root
        assert_eq!(needed(0.002), 2.0 * 4000.0);
        assert_eq!(needed(0.009), 128.0 * 4000.0);
    }
}

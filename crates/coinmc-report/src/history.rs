//! How the estimates of a run converged: the counts after each of its chunks.

use coinmc::plan::Plan;
use coinmc::run::{Report, RunError, stored_chunks};
use coinmc_core::{Estimate, Face, IntervalMethod, Tally};
use serde_json::{Value, json};
use std::path::Path;

/// Runs with more points have no history: it would be larger than all the rest.
const MOST_POINTS: usize = 400;
/// Most steps that are shown of a point.
const MOST_STEPS: usize = 40;

/// The counts after so many tosses.
pub(crate) type Step = Tally;

/// The history of every point that was tossed.
pub(crate) fn read(
    dir: &Path,
    plan: &Plan,
    report: &Report,
) -> Result<Vec<(usize, Vec<Step>)>, RunError> {
    if plan.points.len() > MOST_POINTS {
        return Ok(Vec::new());
    }
    let mut points: Vec<(usize, Vec<Step>)> = Vec::new();
    for (chunk, tally) in stored_chunks(dir, plan)? {
        // tosses of a pilot are not counted
        if chunk.tosses.start < report.results.rows[chunk.point].pilot_tosses {
            continue;
        }
        if points.last().is_none_or(|(point, _)| *point != chunk.point) {
            points.push((chunk.point, Vec::new()));
        }
        let steps = &mut points.last_mut().expect("pushed before").1;
        let before = steps.last().copied().unwrap_or_default();
        // only forged counts overflow
        steps.extend(before.checked_merge(&tally));
    }
    for (_, steps) in &mut points {
        thin(steps);
    }
    Ok(points)
}

/// Leaves the last step, and about as many at each scale.
fn thin(steps: &mut Vec<Step>) {
    let all = steps.len();
    if all <= MOST_STEPS {
        return;
    }
    let share = libm::log(all as f64) / (MOST_STEPS - 1) as f64;
    let mut next = 1.0;
    let mut number = 0_usize;
    steps.retain(|_| {
        number += 1;
        let keep = number as f64 >= next || number == all;
        if keep {
            next = (next * libm::exp(share)).max(next + 1.0);
        }
        keep
    });
}

/// The history for the page: tosses, and P with its interval for each face.
pub(crate) fn to_json(plan: &Plan, history: &[(usize, Vec<Step>)]) -> Value {
    let points = history.iter().map(|(point, steps)| {
        let faces = Face::ALL.map(|face| {
            let estimates: Vec<Estimate> = steps.iter().map(|t| estimate(plan, t, face)).collect();
            let of =
                |number: fn(&Estimate) -> f64| estimates.iter().map(number).collect::<Vec<_>>();
            json!({ "p": of(|e| e.p), "lo": of(|e| e.lo), "hi": of(|e| e.hi) })
        });
        json!({
            "point": point,
            "tosses": steps.iter().map(Tally::tosses).collect::<Vec<_>>(),
            "faces": faces,
        })
    });
    points.collect()
}

fn estimate(plan: &Plan, tally: &Tally, face: Face) -> Estimate {
    let (count, undecided, tosses) = (tally.count(face), tally.undecided(), tally.tosses());
    Estimate::new(
        count,
        undecided,
        tosses,
        plan.confidence,
        IntervalMethod::Wilson,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_history_keeps_its_ends_and_its_scales() {
        let of = |heads| Tally {
            heads,
            ..Tally::default()
        };
        let mut steps: Vec<Step> = (1..=100_000).map(of).collect();
        thin(&mut steps);
        assert!(
            (20..=2 * MOST_STEPS).contains(&steps.len()),
            "{}",
            steps.len()
        );
        assert_eq!((steps[0].heads, steps.last().unwrap().heads), (1, 100_000));
        assert!(
            steps
                .windows(2)
                .skip(20)
                .all(|w| w[1].heads < 2 * w[0].heads)
        );
    }
}

//! From counts to probabilities with intervals, for points with a fixed number of tosses and for points
//! that stop at targets.

use crate::plan::{Plan, Point, Stop};
use coinmc_core::{Estimate, Face, IntervalMethod, Tally};
use coinmc_quadrature::{Integral, Share};

/// Name of the interval of a closed form.
pub(super) const EXACT: &str = "exact";
/// Name of the interval of an integral.
pub(super) const STUDENT: &str = "student-t";
/// Names of how launches were drawn.
pub(super) const RANDOM: &str = "random";
pub(super) const QUASI_RANDOM: &str = "quasi-random";
pub(super) const CLOSED_FORM: &str = "closed-form";
/// Name of the interval of a point that stops at targets.
const SEQUENTIAL: &str = "sequential-clopper-pearson";
/// All names of intervals, and all of how launches were drawn.
pub(super) const INTERVALS: [&str; 5] = ["wilson", "clopper-pearson", SEQUENTIAL, STUDENT, EXACT];
pub(super) const SAMPLINGS: [&str; 3] = [RANDOM, QUASI_RANDOM, CLOSED_FORM];

/// The estimates of heads, tails and side at a point, given its tosses so far.
///
/// A closed form's are exact: `lo = p = hi`, no tosses. A point that stops at targets is looked at with
/// the confidence `at_look`, so that all looks together have that of the plan.
pub(crate) fn estimates(plan: &Plan, point: &Point, tally: &Tally, at_look: f64) -> [Estimate; 3] {
    if let Some(faces) = point.exact() {
        return faces.map(|p| Estimate {
            p,
            lo: p,
            hi: p,
            n: 0,
            confidence: plan.confidence,
            method: plan.interval,
        });
    }
    Face::ALL.map(|face| of_count(plan, tally, tally.count(face), at_look))
}

/// The estimate of what `count` of the tosses show, and the undecided ones may have shown.
pub(crate) fn of_count(plan: &Plan, tally: &Tally, count: u64, at_look: f64) -> Estimate {
    let (confidence, method) = match plan.stop {
        Stop::Tosses(_) => (plan.confidence, plan.interval),
        Stop::Targets(_) => (at_look, IntervalMethod::ClopperPearson),
    };
    let found = Estimate::new(count, tally.undecided(), tally.tosses(), confidence, method);
    Estimate {
        confidence: plan.confidence,
        ..found
    }
}

/// The estimates of heads, tails and side of an integral; `n` counts its evaluations.
pub(crate) fn integrated(plan: &Plan, integral: &Integral) -> [Estimate; 3] {
    integral.faces.map(|Share { p, lo, hi }| Estimate {
        p,
        lo,
        hi,
        n: integral.evaluations,
        confidence: plan.confidence,
        method: plan.interval,
    })
}

/// Name of the interval method of a point, as results show it.
pub(crate) fn interval_name(plan: &Plan, point: &Point) -> &'static str {
    match plan.stop {
        _ if !point.engine.makes_tosses() => EXACT,
        Stop::Tosses(_) => plan.interval.name(),
        Stop::Targets(_) => SEQUENTIAL,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// With targets, the interval that covers at least what it states, with the confidence of the look; with a
    /// fixed number of tosses the interval and the confidence of the plan.
    #[test]
    fn the_interval_of_a_count_is_that_of_the_way_to_stop() {
        for (stop, confidence, method) in [
            ("half_width = 0.01", 0.97, IntervalMethod::ClopperPearson),
            ("tosses = 1000", 0.9, IntervalMethod::Wilson),
        ] {
            let text = format!(
                "coin.ratio = 1\nsurface = {{ restitution = 0.5, friction = 0.3 }}\n\
                 launch.preset = 'robot'\nengine.flat = {{}}\nestimate.confidence = 0.9\nstop.{stop}"
            );
            let plan = crate::config::parse("inline", &text, &[]).unwrap();
            let tally = Tally {
                heads: 600,
                tails: 100,
                side: 290,
                never_settles: 10,
                ..Tally::default()
            };
            let found = of_count(&plan, &tally, tally.side, 0.97);
            let expected = Estimate::new(290, 10, 1000, confidence, method);
            assert_eq!((found.lo, found.hi), (expected.lo, expected.hi), "{stop}");
            assert_eq!((found.p, found.confidence), (0.29, 0.9));
        }
    }
}

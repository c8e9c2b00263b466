//! From counts to probabilities with intervals, for points with a fixed number of tosses and for points
//! that stop at targets.

use crate::plan::{Plan, Stop, Targets, looks};
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

/// The estimates of heads, tails and side at point `index`, given its tosses so far.
///
/// A closed form's are exact: `lo = p = hi`, no tosses.
///
/// A point that stops at targets is looked at up to K times, at toss counts fixed
/// beforehand. If each look's interval misses the truth with probability at most α/K, then the
/// chance that any of them does is at most α, and so is that of the one it stops at, however the
/// decision to stop depends on the data (Bonferroni). This requires an interval with at least nominal
/// coverage at every p and n: Clopper and Pearson's, whatever the plan says.
pub(crate) fn estimates(plan: &Plan, index: usize, tally: &Tally) -> [Estimate; 3] {
    if let Some(faces) = plan.points[index].exact() {
        return faces.map(|p| Estimate {
            p,
            lo: p,
            hi: p,
            n: 0,
            confidence: plan.confidence,
            method: plan.interval,
        });
    }
    let method = match plan.stop {
        Stop::Tosses(_) => plan.interval,
        Stop::Targets(_) => IntervalMethod::ClopperPearson,
    };
    Face::ALL.map(|face| {
        let (count, undecided) = (tally.count(face), tally.undecided());
        let at_look = Estimate::new(
            count,
            undecided,
            tally.tosses(),
            look_confidence(plan),
            method,
        );
        Estimate {
            confidence: plan.confidence,
            ..at_look
        }
    })
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

/// Confidence of the interval of a single look, so that all looks together have the plan's.
pub(crate) fn look_confidence(plan: &Plan) -> f64 {
    match plan.stop {
        Stop::Tosses(_) => plan.confidence,
        Stop::Targets(Targets { max_tosses, .. }) => {
            1.0 - (1.0 - plan.confidence) / looks(max_tosses).count() as f64
        }
    }
}

/// Name of the interval method of a point, as results show it.
pub(crate) fn interval_name(plan: &Plan, index: usize) -> &'static str {
    match plan.stop {
        _ if !plan.points[index].engine.makes_tosses() => EXACT,
        Stop::Tosses(_) => plan.interval.name(),
        Stop::Targets(_) => "sequential-clopper-pearson",
    }
}

//! The checks of one experiment.

use super::SIGNIFICANCE;
use super::binomial::{Binomial, Power};
use super::kolmogorov::{self, distance, kolmogorov_p_value};
use crate::Experiment;
use crate::journal::{History, Resolution, Throw};
use coinmc_core::{Estimate, Face, IntervalMethod, Marginal};

/// Confidence of every interval.
const CONFIDENCE: f64 = 0.95;

/// All checks of an experiment.
#[derive(Debug, Clone, PartialEq)]
pub struct FairnessReport {
    /// Throws with a result.
    pub done: u64,
    /// Throws without a result; they are in no check, and bias all checks unless they are few.
    pub voids: u64,
    /// Fraction of void throws, with its interval.
    pub void_share: Interval,
    /// The checks.
    pub checks: Vec<Check>,
    /// Checks that were not made, and why.
    pub remarks: Vec<String>,
}

/// A value with its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// The value.
    pub value: f64,
    /// Lower end.
    pub lo: f64,
    /// Upper end.
    pub hi: f64,
}

/// One check.
#[derive(Debug, Clone, PartialEq)]
pub struct Check {
    /// Name of the check.
    pub name: String,
    /// Name of the test.
    pub test: &'static str,
    /// Number of throws.
    pub n: u64,
    /// Value for a fair robot.
    pub expected: f64,
    /// Measured value: a fraction with its interval (Clopper–Pearson), or the Kolmogorov–Smirnov
    /// distance D with the value that 95 % of fair samples do not exceed.
    pub found: Interval,
    /// Probability that a fair robot deviates at least as much.
    pub p_value: f64,
    /// The smallest bias that this number of throws detects.
    pub power: Power,
}

/// Checks an experiment with a coin, or with `die` one with a cube, whose heads and tails are two
/// of its six faces and whose side is the other four.
pub fn fairness(experiment: &Experiment, history: &History, die: bool) -> FairnessReport {
    let done: Vec<&Throw> = history
        .throws()
        .iter()
        .filter(|throw| throw.resolution == Some(Resolution::Done))
        .collect();
    let count = |face| done.iter().filter(|t| face_of(t) == Some(face)).count() as u64;
    let [heads, tails, side] = Face::ALL.map(count);
    let n = done.len() as u64;
    let voids = history.throws().iter().filter(|t| is_void(t)).count() as u64;
    let mut checks = vec![share(
        "heads among heads and tails",
        heads,
        heads + tails,
        0.5,
    )];
    checks.push(difference(heads, tails, n));
    if die {
        checks.push(share("heads, a face of six", heads, n, 1.0 / 6.0));
        checks.push(share("tails, a face of six", tails, n, 1.0 / 6.0));
        checks.push(share("side, four faces of six", side, n, 2.0 / 3.0));
    }
    let mut remarks = Vec::new();
    let (spin, angle) = experiment.marginals();
    let achieved = |of: fn(&Throw) -> Option<f64>| done.iter().filter_map(|t| of(t)).collect();
    for (name, marginal, sample) in [
        ("achieved spin, rev/s", spin, achieved(spin_of)),
        ("achieved start angle, degrees", angle, achieved(angle_of)),
    ] {
        match uniformity(name, marginal, sample) {
            Ok(check) => checks.push(check),
            Err(remark) => remarks.push(remark),
        }
    }
    FairnessReport {
        done: n,
        voids,
        void_share: exact_interval(voids, n + voids),
        checks,
        remarks,
    }
}

/// Checks the counts of a die's faces: each by itself, and all together by the smallest p-value
/// times their number (Bonferroni).
///
/// # Example
/// ```
/// let checks = coinmc_robot::fairness::die_check(&[170, 160, 171, 158, 172, 169]);
/// assert_eq!(checks.len(), 7);
/// assert!(checks[6].p_value > 0.05);
/// ```
pub fn die_check(counts: &[u64]) -> Vec<Check> {
    let n = counts.iter().sum();
    let p = 1.0 / counts.len() as f64;
    let mut checks: Vec<Check> = counts
        .iter()
        .enumerate()
        .map(|(face, count)| share(&format!("face {}", face + 1), *count, n, p))
        .collect();
    let furthest = checks
        .iter()
        .min_by(|a, b| a.p_value.total_cmp(&b.p_value))
        .cloned();
    if let Some(furthest) = furthest {
        let faces = counts.len() as f64;
        checks.push(Check {
            name: format!("most extreme of {faces} faces"),
            test: "Bonferroni",
            p_value: (furthest.p_value * faces).min(1.0),
            power: Binomial::power(n, p, SIGNIFICANCE / faces),
            ..furthest
        });
    }
    checks
}

fn share(name: &str, count: u64, n: u64, p: f64) -> Check {
    Check {
        name: name.to_owned(),
        test: "exact binomial",
        n,
        expected: p,
        found: exact_interval(count, n),
        p_value: Binomial::new(n, p).two_sided_p_value(count),
        power: Binomial::power(n, p, SIGNIFICANCE),
    }
}

/// Heads minus tails as a fraction of all throws. Given the total of both, the number of heads is
/// binomial, so test and interval are those of heads among both, in other units.
fn difference(heads: u64, tails: u64, n: u64) -> Check {
    let both = heads + tails;
    let share = share("", heads, both, 0.5);
    let scale = both as f64 / n as f64;
    let found = |p: f64| (2.0 * p - 1.0) * scale;
    Check {
        name: "heads minus tails, of all throws".to_owned(),
        test: "exact conditional",
        n,
        expected: 0.0,
        found: Interval {
            value: found(share.found.value),
            lo: found(share.found.lo),
            hi: found(share.found.hi),
        },
        p_value: share.p_value,
        power: Power {
            at_80: 2.0 * scale * share.power.at_80,
            at_95: 2.0 * scale * share.power.at_95,
        },
    }
}

fn exact_interval(count: u64, n: u64) -> Interval {
    let estimate = Estimate::new(count, 0, n, CONFIDENCE, IntervalMethod::ClopperPearson);
    Interval {
        value: estimate.p,
        lo: estimate.lo,
        hi: estimate.hi,
    }
}

fn uniformity(name: &str, marginal: Marginal, mut sample: Vec<f64>) -> Result<Check, String> {
    let Marginal::Uniform { from, to } = marginal else {
        return Err(format!("{name}: not uniform in the config, not checked"));
    };
    if sample.is_empty() || from >= to {
        return Err(format!("{name}: nothing to check"));
    }
    let n = sample.len() as u64;
    let d = distance(&mut sample, |x| ((x - from) / (to - from)).clamp(0.0, 1.0));
    let critical =
        super::binomial::least_shift(1.0, |d| kolmogorov_p_value(n, d) <= 1.0 - CONFIDENCE);
    Ok(Check {
        name: format!("{name}, uniform"),
        test: "Kolmogorov-Smirnov",
        n,
        expected: 0.0,
        found: Interval {
            value: d,
            lo: 0.0,
            hi: critical,
        },
        p_value: kolmogorov_p_value(n, d),
        power: kolmogorov::power(n),
    })
}

fn face_of(throw: &Throw) -> Option<Face> {
    throw.reading.as_ref().map(|(reading, _)| reading.face)
}

fn spin_of(throw: &Throw) -> Option<f64> {
    let (reading, _) = throw.reading.as_ref()?;
    Some(f64::from(reading.measured.spin_mrev_s) / 1e3)
}

fn angle_of(throw: &Throw) -> Option<f64> {
    let (reading, _) = throw.reading.as_ref()?;
    Some(f64::from(reading.measured.angle_cdeg) / 1e2)
}

fn is_void(throw: &Throw) -> bool {
    matches!(throw.resolution, Some(Resolution::Void(_)))
}

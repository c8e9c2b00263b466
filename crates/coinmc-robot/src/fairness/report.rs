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
    /// Fraction of void throws, with its interval; `None` before the first throw.
    pub void_share: Option<Interval>,
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
    /// distance D of the sample with the interval of that of its distribution.
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
    let mut found = vec![
        share("heads among heads and tails", heads, heads + tails, 0.5),
        difference(heads, tails, n),
    ];
    if die {
        found.push(share("heads, a face of six", heads, n, 1.0 / 6.0));
        found.push(share("tails, a face of six", tails, n, 1.0 / 6.0));
        found.push(share("side, four faces of six", side, n, 2.0 / 3.0));
    }
    let (spin, angle) = experiment.marginals();
    let achieved = |of: fn(&Throw) -> Option<f64>| done.iter().filter_map(|t| of(t)).collect();
    for (name, marginal, sample) in [
        ("achieved spin, rev/s", spin, achieved(spin_of)),
        ("achieved start angle, degrees", angle, achieved(angle_of)),
    ] {
        found.push(uniformity(name, marginal, sample));
    }
    let (mut checks, mut remarks) = (Vec::new(), Vec::new());
    for found in found {
        match found {
            Ok(check) => checks.push(check),
            Err(remark) => remarks.push(remark),
        }
    }
    FairnessReport {
        done: n,
        voids,
        void_share: (n + voids > 0).then(|| exact_interval(voids, n + voids)),
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
        .filter_map(|(face, count)| share(&format!("face {}", face + 1), *count, n, p).ok())
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

/// The check of a share, or a remark where there is nothing to have a share of.
fn share(name: &str, count: u64, n: u64, p: f64) -> Result<Check, String> {
    if n == 0 {
        return Err(nothing(name));
    }
    Ok(Check {
        name: name.to_owned(),
        test: "exact binomial",
        n,
        expected: p,
        found: exact_interval(count, n),
        p_value: Binomial::new(n, p).two_sided_p_value(count),
        power: Binomial::power(n, p, SIGNIFICANCE),
    })
}

fn nothing(name: &str) -> String {
    format!("{name}: nothing to check")
}

/// Heads minus tails as a fraction of all throws. Given the total of both, the number of heads is
/// binomial, so test and interval are those of heads among both, in other units.
fn difference(heads: u64, tails: u64, n: u64) -> Result<Check, String> {
    let name = "heads minus tails, of all throws";
    let both = heads + tails;
    let share = share(name, heads, both, 0.5)?;
    let scale = both as f64 / n as f64;
    let found = |p: f64| (2.0 * p - 1.0) * scale;
    Ok(Check {
        test: "exact conditional",
        n,
        expected: 0.0,
        found: Interval {
            value: found(share.found.value),
            lo: found(share.found.lo),
            hi: found(share.found.hi),
        },
        power: Power {
            at_80: 2.0 * scale * share.power.at_80,
            at_95: 2.0 * scale * share.power.at_95,
        },
        ..share
    })
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
        return Err(nothing(name));
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
        // no distribution differs from the sample by more than that, but for one sample of twenty
        found: Interval {
            value: d,
            lo: (d - critical).max(0.0),
            hi: (d + critical).min(1.0),
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Without throws, or with all on the side, there is no share to check, and none is stated.
    #[test]
    fn nothing_is_stated_of_no_throws() {
        for n in [0, 5] {
            let told = difference(0, 0, n).unwrap_err();
            assert_eq!(told, "heads minus tails, of all throws: nothing to check");
        }
        assert!(share("heads", 0, 0, 0.5).is_err());
        assert!(share("heads", 0, 1, 0.5).is_ok());
    }

    /// The interval of a distance has the distance in it: 0.0565 is critical for 576 throws (1.358/sqrt(n), tables).
    #[test]
    fn the_interval_of_a_distance_holds_it() {
        let of = |scale: f64| {
            let sample = (0..576).map(|i| scale * (f64::from(i) + 0.5) / 576.0);
            let uniform = Marginal::Uniform { from: 0.0, to: 1.0 };
            uniformity("spin", uniform, sample.collect()).unwrap().found
        };
        let near = of(1.0);
        assert!(near.lo == 0.0 && near.value < 0.001 && (near.hi - 0.057).abs() < 2e-3);
        let far = of(0.8);
        assert!((far.value - 0.2).abs() < 1e-2, "{far:?}");
        for arm in [far.value - far.lo, far.hi - far.value] {
            assert!((arm - 0.0565).abs() < 1e-3, "{far:?}");
        }
        assert_eq!(of(1e-9).hi, 1.0);
    }
}

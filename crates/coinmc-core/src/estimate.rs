//! A probability with its interval.

use crate::beta::beta_quantile;
use crate::inverse_normal_cdf;

/// How the interval of a proportion is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum IntervalMethod {
    /// Wilson's score interval (1927): coverage close to nominal on average, short. The default
    /// for a number of tosses fixed beforehand.
    #[default]
    Wilson,
    /// Clopper & Pearson (1934): coverage never below nominal, longer. Sequential stopping and rare
    /// faces need it.
    ClopperPearson,
}

impl IntervalMethod {
    /// The name used in configs and results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Wilson => "wilson",
            Self::ClopperPearson => "clopper-pearson",
        }
    }
}

/// An estimated probability: the share of tosses, and an interval that holds the true one with
/// the stated confidence.
///
/// Undecided tosses are counted in `n` and could have ended either way: `lo` counts none of them and
/// `hi` all, so the interval is valid however they would have ended.
///
/// # Example
/// ```
/// use coinmc_core::{Estimate, IntervalMethod};
/// // Kerrich 1946: 5067 heads in 10000 tosses
/// let heads = Estimate::new(5067, 0, 10_000, 0.95, IntervalMethod::Wilson);
/// assert!((heads.lo - 0.4969).abs() < 1e-4 && (heads.hi - 0.5165).abs() < 1e-4);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// Share of tosses that showed the face, all tosses counted; NaN without tosses.
    pub p: f64,
    /// Lower end of the interval.
    pub lo: f64,
    /// Upper end of the interval.
    pub hi: f64,
    /// All tosses, undecided ones included.
    pub n: u64,
    /// Probability that the interval holds the true value (before the data were seen).
    pub confidence: f64,
    /// How the interval was computed.
    pub method: IntervalMethod,
}

impl Estimate {
    /// Estimates a probability from `successes` in `n` tosses of which `undecided` have no face.
    ///
    /// # Panics
    /// If there are fewer tosses than successes and undecided ones, or `confidence` is not in (0, 1).
    pub fn new(
        successes: u64,
        undecided: u64,
        n: u64,
        confidence: f64,
        method: IntervalMethod,
    ) -> Self {
        assert!(successes + undecided <= n && confidence > 0.0 && confidence < 1.0);
        let (lo, hi) = if n == 0 {
            (0.0, 1.0)
        } else {
            let tail = (1.0 - confidence) / 2.0;
            let most = successes + undecided;
            match method {
                IntervalMethod::Wilson => (wilson(successes, n, tail).0, wilson(most, n, tail).1),
                IntervalMethod::ClopperPearson => (
                    clopper_pearson(successes, n, tail).0,
                    clopper_pearson(most, n, tail).1,
                ),
            }
        };
        Self {
            p: successes as f64 / n as f64,
            lo,
            hi,
            n,
            confidence,
            method,
        }
    }

    /// The longer of the two distances from `p` to the ends of the interval.
    pub fn half_width(&self) -> f64 {
        if self.n == 0 {
            1.0
        } else {
            (self.hi - self.p).max(self.p - self.lo)
        }
    }
}

/// Score interval: all p with |p̂ − p| <= z sqrt(p(1 − p)/n). Wilson, JASA 22 (1927) 209.
fn wilson(k: u64, n: u64, tail: f64) -> (f64, f64) {
    // the upper tail's quantile by symmetry: 1 − tail would round a small tail away
    let z = -inverse_normal_cdf(tail);
    let (k_f, n_f) = (k as f64, n as f64);
    let p = k_f / n_f;
    let z2n = z * z / n_f;
    let centre = p + z2n / 2.0;
    let arm = z * (p * (1.0 - p) / n_f + z2n / (4.0 * n_f)).sqrt();
    let scale = 1.0 / (1.0 + z2n);
    let lo = if k == 0 {
        0.0
    } else {
        ((centre - arm) * scale).max(0.0)
    };
    let hi = if k == n {
        1.0
    } else {
        ((centre + arm) * scale).min(1.0)
    };
    (lo, hi)
}

/// The p at which k or more successes have probability `tail`, and the one at which k or fewer
/// have: Clopper & Pearson, Biometrika 26 (1934) 404. P(K >= k) = I_p(k, n − k + 1); the upper
/// limit is the lower one of the failures.
fn clopper_pearson(k: u64, n: u64, tail: f64) -> (f64, f64) {
    let limit = |k: u64| beta_quantile(k as f64, (n - k) as f64 + 1.0, tail);
    (
        if k == 0 { 0.0 } else { limit(k).0 },
        if k == n { 1.0 } else { limit(n - k).1 },
    )
}

/// The t that Student's distribution with `dof` degrees of freedom exceeds with probability `tail`,
/// 0 < `tail` < ½.
///
/// P(T > t) = ½ I_x(ν/2, ½) with x = ν/(ν + t²), I the regularised incomplete beta function.
///
/// # Example
/// ```
/// use coinmc_core::student_t_quantile;
/// assert!((student_t_quantile(15.0, 0.025) - 2.131_449_545_559_323).abs() < 1e-9);
/// ```
pub fn student_t_quantile(dof: f64, tail: f64) -> f64 {
    let (x, rest) = beta_quantile(dof / 2.0, 0.5, 2.0 * tail);
    (dof * rest / x).sqrt()
}

/// Exact relative standard error of an estimated probability, ΔP/P = sqrt((1 − P)/(P N)).
///
/// # Example
/// ```
/// use coinmc_core::{relative_error, rule_of_thumb_relative_error};
/// assert_eq!(relative_error(0.5, 10_000), rule_of_thumb_relative_error(10_000));
/// // a face that shows once in 1000 tosses needs 32 times the rule of thumb's tosses²
/// assert!((relative_error(0.001, 10_000) / 0.01 - 31.6).abs() < 0.01);
/// ```
pub fn relative_error(p: f64, n: u64) -> f64 {
    ((1.0 - p) / (p * n as f64)).sqrt()
}

/// The rule of thumb ΔP/P = 1/sqrt(N) of Gaek & Sukhov (arXiv 2401.03557), exact only at P = ½.
pub fn rule_of_thumb_relative_error(n: u64) -> f64 {
    1.0 / (n as f64).sqrt()
}

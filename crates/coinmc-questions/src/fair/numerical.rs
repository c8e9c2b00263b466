//! How far the engine's numerical error moves a root, by tossing again with finer settings.

use coinmc::plan::Plan;
use coinmc_core::Finer;

/// The shift of a root with finer numerical settings, with its interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Numerical {
    /// How far the root would move.
    pub shift: f64,
    /// Lower end of its interval.
    pub lo: f64,
    /// Upper end.
    pub hi: f64,
    /// Pairs of tosses with the same random numbers.
    pub tosses: u64,
}

impl Numerical {
    /// From the tosses that gain and lose the face with finer settings, and the slope dP/d(parameter):
    /// a probability higher by Δ moves the root by −Δ/slope. The variance of Δ is that of paired
    /// proportions (McNemar, Psychometrika 12 (1947) 153).
    pub(super) fn new([gained, lost]: [u64; 2], tosses: u64, slope: f64, z: f64) -> Self {
        let (gained, lost, n) = (gained as f64, lost as f64, tosses as f64);
        let change = (gained - lost) / n;
        // one more change of either kind, so that no change seen does not mean no error
        let variance = (gained + lost + 1.0 - (gained - lost) * change) / (n * n);
        let (shift, arm) = (-change / slope, z * variance.sqrt() / slope.abs());
        Self {
            shift,
            lo: shift - arm,
            hi: shift + arm,
            tosses,
        }
    }
}

/// The finer settings of a plan's engine, TOML by key.
pub(super) fn finer(plan: &Plan) -> Vec<(String, String)> {
    let engine = plan.points[0].engine.descriptor();
    let settings = engine.finer.iter().filter_map(|(key, finer)| {
        let key = format!("engine.{}.{key}", engine.name);
        let value = match finer {
            Finer::Times(factor) => format!("{:?}", plan.number(&key)? * factor),
            Finer::Word(word) => format!("{word:?}"),
        };
        Some((key, value))
    });
    settings.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 30 of 10,000 tosses more show the face, with 130 changes: Δ = .003, and its standard error
    /// sqrt(131 − .09)/10,000.
    #[test]
    fn changes_become_a_shift() {
        let found = Numerical::new([80, 50], 10_000, -0.5, 2.0);
        assert!((found.shift - 0.006).abs() < 1e-12);
        let arm = 2.0 * (131.0_f64 - 0.09).sqrt() / 10_000.0 / 0.5;
        assert!((found.hi - 0.006 - arm).abs() < 1e-12 && (found.lo - 0.006 + arm).abs() < 1e-12);
    }

    #[test]
    fn no_change_leaves_an_error() {
        assert!(Numerical::new([0, 0], 1000, 1.0, 2.0).hi > 0.0);
    }
}

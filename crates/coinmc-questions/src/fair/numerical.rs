//! How far the engine's numerical error moves a root, by tossing again with finer settings.

use crate::Interval;
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
    /// From the change of the face's probability with finer settings, and the slope dP/d(parameter): a
    /// probability higher by Δ moves the root by −Δ/slope.
    pub(super) fn new(change: Interval, tosses: u64, slope: f64) -> Self {
        let moved = |change: f64| -change / slope;
        let [one, other] = [change.lo, change.hi].map(moved);
        Self {
            shift: moved(change.value),
            lo: one.min(other),
            hi: one.max(other),
            tosses,
        }
    }
}

/// The finer settings of a plan's engine, TOML by key, which show its numerical error; none if it has none.
pub fn finer_settings(plan: &Plan) -> Vec<(String, String)> {
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

    #[test]
    fn a_probability_that_rises_moves_a_rising_root_down() {
        let change = Interval {
            value: 0.003,
            lo: 0.001,
            hi: 0.007,
        };
        let found = Numerical::new(change, 10_000, 0.5);
        assert!((found.shift + 0.006).abs() < 1e-12);
        assert!((found.lo + 0.014).abs() < 1e-12 && (found.hi + 0.002).abs() < 1e-12);
        let falling = Numerical::new(change, 10_000, -0.5);
        assert_eq!(
            (falling.shift, falling.lo, falling.hi),
            (-found.shift, -found.hi, -found.lo)
        );
    }
}

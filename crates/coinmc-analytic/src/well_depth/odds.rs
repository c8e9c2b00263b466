//! The ratio at which the odds of the side have a given value.

/// Odds of the side at one ratio, and how steeply they rise there.
pub(super) struct Odds {
    /// P(side)/(1 − P(side)).
    pub(super) value: f64,
    /// d ln(odds)/d ln(ratio).
    pub(super) log_slope: f64,
}

/// Below this guess a rule equals its leading power of `x` to rounding; Newton's method would only
/// meet subnormal numbers.
const LEADING_POWER_IS_EXACT: f64 = 1e-20;

/// A step of Newton's method squares the error, so a step this short is the last.
const LAST_STEP: f64 = 1e-8;

/// Never reached: from the asymptotic guesses four or five steps are enough.
const MAX_STEPS: usize = 40;

/// Solves `odds(x).value = target` for a rule whose odds rise like a power of `x` between 3 and
/// 4.24.
///
/// Newton's method on logarithms. With `f` = ln odds as a function of ln x and `e` the error, one
/// step leaves `e·(1 − f'(ξ)/f'(x))` for some ξ between. The slopes of the rules lie within a
/// factor of two of each other (tested), so the error shrinks from any start and no bracket is
/// needed.
pub(super) fn solve(target: f64, guess: f64, odds: impl Fn(f64) -> Odds) -> f64 {
    let mut ratio = guess;
    if !(LEADING_POWER_IS_EXACT..f64::INFINITY).contains(&guess) {
        return guess;
    }
    for _ in 0..MAX_STEPS {
        let Odds { value, log_slope } = odds(ratio);
        let step = libm::log(value / target) / log_slope;
        ratio *= libm::exp(-step);
        if step.abs() < LAST_STEP {
            break;
        }
    }
    ratio
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    /// For a power law one step of Newton's method on logarithms arrives; a second sees that.
    #[test]
    fn the_search_ends_with_the_first_short_step() {
        let steps = Cell::new(0);
        let cube = |ratio: f64| {
            steps.set(steps.get() + 1);
            Odds {
                value: ratio * ratio * ratio,
                log_slope: 3.0,
            }
        };
        let found = solve(8.0, 1.0, cube);
        // a logarithm and an exponential of numbers near 1
        assert!((found - 2.0).abs() < 4.0 * f64::EPSILON, "{found}");
        assert_eq!(steps.get(), 2);
    }
}

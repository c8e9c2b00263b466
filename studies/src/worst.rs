//! The largest value seen, and where.

use coinmc_bench::Case;

/// The largest of many values, and the toss it came from. A NaN is larger than any number: it
/// must not go unnoticed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Worst {
    /// −∞ before the first value.
    pub(crate) value: f64,
    /// Number of the toss.
    pub(crate) toss: u64,
}

/// The larger; what is not a number is larger than any.
pub(crate) fn largest(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}

impl Default for Worst {
    fn default() -> Self {
        Self {
            value: f64::NEG_INFINITY,
            toss: 0,
        }
    }
}

impl Worst {
    /// Looks at a value.
    #[inline]
    pub(crate) fn see(&mut self, value: f64, toss: u64) {
        if value > self.value || (value.is_nan() && !self.value.is_nan()) {
            *self = Self { value, toss };
        }
    }

    /// The worst of several cases, with the case it came from; `None` without cases.
    pub(crate) fn over<'a>(
        all: impl Iterator<Item = (&'a Case, Self)>,
    ) -> Option<(&'a Case, Self)> {
        all.reduce(|worst, next| {
            let mut both = worst.1;
            both.see(next.1.value, next.1.toss);
            if both.value.to_bits() == worst.1.value.to_bits() {
                worst
            } else {
                next
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use coinmc_core::Preset;

    #[test]
    fn the_largest_wins_and_nan_is_larger_still() {
        let mut worst = Worst::default();
        for (toss, value) in [1.0, 3.0, 2.0].into_iter().enumerate() {
            worst.see(value, toss as u64);
        }
        assert_eq!((worst.value, worst.toss), (3.0, 1));
        worst.see(f64::NAN, 7);
        worst.see(9.0, 8);
        assert!(worst.value.is_nan() && worst.toss == 7);
    }

    #[test]
    fn the_worst_case_is_the_one_with_the_worst_value() {
        let cases = [1.0, 2.0, 3.0].map(|x| Case::new(Preset::Robot, 0.01, x, 0.5, 0.3));
        let values = [1.0, 5.0, 4.0].map(|value| Worst { value, toss: 0 });
        let (case, worst) = Worst::over(cases.iter().zip(values)).unwrap();
        assert_eq!((case.scene.coin.ratio(), worst.value), (2.0, 5.0));
    }
}

//! A number, or the values it takes in a sweep.

/// A number that may be swept.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Quantity {
    Constant(f64),
    /// At least two values, in the order given.
    List(Vec<f64>),
    Range(Range),
}

/// Evenly spaced values with both ends, not yet written out: a range may ask for more values
/// than a sweep may have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Range {
    pub(super) from: f64,
    pub(super) to: f64,
    /// At least 2.
    pub(super) steps: u64,
    pub(super) log: bool,
}

impl Quantity {
    /// Number of values.
    pub(super) fn len(&self) -> u64 {
        match self {
            Self::Constant(_) => 1,
            Self::List(values) => values.len() as u64,
            Self::Range(range) => range.steps,
        }
    }

    pub(super) fn values(&self) -> Vec<f64> {
        match self {
            Self::Constant(value) => vec![*value],
            Self::List(values) => values.clone(),
            Self::Range(range) => (0..range.steps).map(|i| range.value(i)).collect(),
        }
    }

    /// The same with every value, or both ends of a range, replaced: for functions that multiply.
    pub(super) fn map(&self, f: impl Fn(f64) -> f64) -> Self {
        match self {
            Self::Constant(value) => Self::Constant(f(*value)),
            Self::List(values) => Self::List(values.iter().map(|value| f(*value)).collect()),
            Self::Range(range) => Self::Range(Range {
                from: f(range.from),
                to: f(range.to),
                ..*range
            }),
        }
    }

    /// The canonical form of these values: a list that equals a range becomes that range.
    pub(super) fn canonical(&self) -> Self {
        let values = self.values();
        match values[..] {
            [value] => Self::Constant(value),
            [from, _, .., to] if from < to => {
                let steps = values.len() as u64;
                [false, true]
                    .map(|log| Range {
                        from,
                        to,
                        steps,
                        log,
                    })
                    .into_iter()
                    .filter(|range| !range.log || from > 0.0)
                    .find(|range| (0..steps).zip(&values).all(|(i, v)| range.value(i) == *v))
                    .map_or(Self::List(values), Self::Range)
            }
            _ => Self::List(values),
        }
    }
}

impl Range {
    /// Value number `i`; the ends are exact. Others are rounded so that 0.2 to 2.0 in 19 steps passes through 0.3 and not through
    /// 0.30000000000000004: to 15 digits of the larger end, or to 12 digits of the value itself on
    /// a logarithmic scale (where rounding errors grow with the exponent).
    pub(super) fn value(&self, i: u64) -> f64 {
        let last = self.steps - 1;
        if i == 0 {
            return self.from;
        }
        if i >= last {
            return self.to;
        }
        self.between(i as f64 / last as f64)
    }

    /// The value at the share t of the way, rounded in the same manner.
    pub(super) fn between(&self, t: f64) -> f64 {
        let between = |a: f64, b: f64| a * (1.0 - t) + b * t;
        if self.log {
            return digits(
                libm::exp(between(libm::log(self.from), libm::log(self.to))),
                12,
            );
        }
        let value = between(self.from, self.to);
        let lost = exponent(self.from.abs().max(self.to.abs())) - exponent(value);
        match usize::try_from(15 - lost) {
            Ok(kept) if kept > 0 => digits(value, kept),
            _ => 0.0,
        }
    }
}

/// The nearest number with `count` (at least one) significant decimal digits; formatting and
/// parsing are exact.
pub(super) fn digits(value: f64, count: usize) -> f64 {
    let rounded = format!("{value:.*e}", count - 1).parse().unwrap_or(value);
    // a negative zero would be a second text for the same value
    if rounded == 0.0 { 0.0 } else { rounded }
}

/// The decimal exponent of the leading digit; that of 0 is 0.
fn exponent(value: f64) -> i64 {
    let text = format!("{value:e}");
    text.split_once('e')
        .and_then(|(_, exponent)| exponent.parse().ok())
        .unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn range(from: f64, to: f64, steps: u64, log: bool) -> Quantity {
        Quantity::Range(Range {
            from,
            to,
            steps,
            log,
        })
    }

    #[test]
    fn ranges_pass_through_the_numbers_a_person_expects() {
        let values = range(0.2, 2.0, 19, false).values();
        let expected: Vec<f64> = (2..=20)
            .map(|i| format!("{i}e-1").parse().unwrap())
            .collect();
        assert_eq!(values, expected);
        assert_eq!(
            range(1e-3, 1e3, 7, true).values(),
            [1e-3, 1e-2, 1e-1, 1.0, 1e1, 1e2, 1e3]
        );
        let around_zero: Vec<f64> = (-10..=10).map(|i| f64::from(i) / 10.0).collect();
        assert_eq!(range(-1.0, 1.0, 21, false).values(), around_zero);
    }

    #[test]
    fn a_list_that_equals_a_range_is_written_as_the_range() {
        for quantity in [range(0.2, 2.0, 19, false), range(0.01, 10.0, 4, true)] {
            let list = Quantity::List(quantity.values());
            assert_eq!(list.canonical(), quantity);
            assert_eq!(quantity.canonical(), quantity);
        }
        let uneven = Quantity::List(vec![1.0, 2.0, 4.5]);
        assert_eq!(uneven.canonical(), uneven);
        let pair = Quantity::List(vec![1.0, 2.0]);
        assert_eq!(range(1.0, 2.0, 2, false).canonical(), pair);
    }
}

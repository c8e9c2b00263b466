//! Axes: where a value stands, and which values are labelled.

use crate::span::{Span, rounded};
use libm::{ceil, floor, log, log10, pow};

/// Most ticks of an axis without decades.
const MOST_TICKS: f64 = 6.0;

/// An axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Scale {
    pub(crate) from: f64,
    pub(crate) to: f64,
    logarithmic: bool,
    /// Space before the first and behind the last value, as a share of the way between them.
    margin: f64,
    /// Where the axis begins and ends, px.
    pub(crate) pixels: [f64; 2],
}

impl Scale {
    /// The axis of so many values of a parameter, with half a cell of space at either end.
    pub(crate) fn of_values(span: Span, values: usize, pixels: [f64; 2]) -> Self {
        Self {
            from: span.from,
            to: span.to,
            logarithmic: span.is_logarithmic(),
            margin: 0.5 / (values.max(2) - 1) as f64,
            pixels,
        }
    }

    /// An axis of probabilities that holds all of these, with ends that can be labelled.
    pub(crate) fn of_probabilities(p: impl Iterator<Item = f64>, pixels: [f64; 2]) -> Self {
        let (low, high) = p.fold((1.0_f64, 0.0_f64), |(low, high), p| {
            (low.min(p), high.max(p))
        });
        let step = if high > low { step(low, high) } else { 1.0 };
        let [from, to] = [step * floor(low / step), step * ceil(high / step)];
        let [from, to] = if from < to { [from, to] } else { [0.0, 1.0] };
        Self {
            from: rounded(from.max(0.0)),
            to: rounded(to.min(1.0)),
            logarithmic: false,
            margin: 0.0,
            pixels,
        }
    }

    /// How far a value is on the way between the ends.
    pub(crate) fn share(&self, value: f64) -> f64 {
        if self.logarithmic {
            log(value / self.from) / log(self.to / self.from)
        } else {
            (value - self.from) / (self.to - self.from)
        }
    }

    /// Where a value stands, px.
    pub(crate) fn at(&self, value: f64) -> f64 {
        let share = (self.share(value) + self.margin) / (1.0 + 2.0 * self.margin);
        self.pixels[0] + share * (self.pixels[1] - self.pixels[0])
    }

    /// Whether a value lies between the ends.
    pub(crate) fn holds(&self, value: f64) -> bool {
        (self.from..=self.to).contains(&value)
    }

    /// Values with labels: multiples of 1, 2 or 5 times a power of ten, or of powers of ten.
    pub(crate) fn ticks(&self) -> Vec<f64> {
        if self.logarithmic {
            return decades(self.from, self.to);
        }
        let step = step(self.from, self.to);
        let mut ticks = vec![];
        let mut multiple = ceil(self.from / step - 1e-9);
        while multiple * step <= self.to + 1e-9 * step {
            // no negative zero
            ticks.push(rounded(multiple * step) + 0.0);
            multiple += 1.0;
        }
        ticks
    }
}

/// The smallest of 1, 2 and 5 times a power of ten that divides the range in a few parts.
fn step(from: f64, to: f64) -> f64 {
    let least = (to - from) / MOST_TICKS;
    let power = pow(10.0, floor(log10(least)));
    let steps = [1.0, 2.0, 5.0].map(|digit| digit * power);
    // rounding may leave the least a little above what it is
    let found = steps.into_iter().find(|step| *step >= least * (1.0 - 1e-9));
    found.unwrap_or(10.0 * power)
}

/// Powers of ten; with fewer than three of them 2 and 5 times these as well.
fn decades(from: f64, to: f64) -> Vec<f64> {
    let (first, last) = (floor(log10(from)), ceil(log10(to)));
    let digits: &[f64] = if last - first > 3.0 {
        &[1.0]
    } else {
        &[1.0, 2.0, 5.0]
    };
    let every = ceil((last - first) / 8.0);
    let mut ticks = vec![];
    let mut power = first;
    while power <= last {
        let values = digits.iter().map(|digit| rounded(digit * pow(10.0, power)));
        ticks.extend(values.filter(|value| (from..=to).contains(value)));
        power += every;
    }
    ticks
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scale(from: f64, to: f64) -> Scale {
        Scale::of_values(Span { from, to }, 5, [0.0, 100.0])
    }

    #[test]
    fn ticks_are_round() {
        assert_eq!(scale(0.0, 0.5).ticks(), [0.0, 0.1, 0.2, 0.3, 0.4, 0.5]);
        assert_eq!(
            scale(-60.0, 60.0).ticks(),
            [-60.0, -40.0, -20.0, 0.0, 20.0, 40.0, 60.0]
        );
        assert_eq!(scale(0.03, 1.0).ticks(), [0.05, 0.1, 0.2, 0.5, 1.0]);
        assert_eq!(scale(1.0, 1e5).ticks(), [1.0, 10.0, 100.0, 1e3, 1e4, 1e5]);
        assert!(scale(1e-300, 1e300).ticks().len() < 12);
    }

    /// Five values have cells of a fifth of the axis, and stand at their middles.
    #[test]
    fn values_stand_in_the_middle_of_their_cells() {
        for scale in [scale(0.0, 4.0), scale(1.0, 16.0)] {
            assert!((scale.at(scale.from) - 10.0).abs() < 1e-9);
            assert!((scale.at(scale.to) - 90.0).abs() < 1e-9);
        }
        assert!((scale(1.0, 16.0).at(4.0) - 50.0).abs() < 1e-9);
    }

    #[test]
    fn probabilities_have_round_ends() {
        let ends = |p: &[f64]| {
            let scale = Scale::of_probabilities(p.iter().copied(), [0.0, 1.0]);
            [scale.from, scale.to]
        };
        assert_eq!(ends(&[0.412, 0.587]), [0.4, 0.6]);
        assert_eq!(ends(&[0.01, 0.99]), [0.0, 1.0]);
        assert_eq!(ends(&[1.0, 1.0]), [0.0, 1.0]);
        assert_eq!(ends(&[0.3, 0.3]), [0.0, 1.0]);
    }
}

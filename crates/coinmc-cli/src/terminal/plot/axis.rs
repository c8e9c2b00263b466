//! From values to cells and back, with ticks at round numbers.

use crate::terminal::compact;

/// A range of more than this factor is drawn on a logarithmic axis.
const LOGARITHMIC_FROM: f64 = 20.0;

/// A tick: where, and what is written there.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tick {
    pub(super) cell: usize,
    pub(super) label: String,
}

/// A linear or logarithmic map of an interval to cells.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Axis {
    /// Ends, as logarithms on a logarithmic axis.
    from: f64,
    to: f64,
    logarithmic: bool,
    cells: usize,
    wanted_ticks: f64,
}

impl Axis {
    /// An axis that just holds these values, finite ones only. `None` if there are not two
    /// different ones.
    pub(super) fn horizontal(values: impl Iterator<Item = f64>, cells: usize) -> Option<Self> {
        let (least, most) = extent(values)?;
        if least >= most {
            return None;
        }
        let logarithmic = least > 0.0 && most / least > LOGARITHMIC_FROM;
        let scaled = |x| if logarithmic { libm::log10(x) } else { x };
        let (from, to) = (scaled(least), scaled(most));
        (to > from).then_some(Self {
            from,
            to,
            logarithmic,
            cells,
            wanted_ticks: 8.0,
        })
    }

    /// An axis for probabilities: from one round number to another, within 0 and 1.
    pub(super) fn vertical(values: impl Iterator<Item = f64>, cells: usize) -> Option<Self> {
        let (least, most) = extent(values)?;
        let (least, most) = (least.max(0.0), most.min(1.0));
        // Equal probabilities still deserve a picture: a tenth around them.
        let range = (most - least).max(0.02);
        let step = round_step(range / 5.0);
        let from = (libm::floor(least / step + 1e-9) * step).max(0.0);
        let to = (libm::ceil(most / step - 1e-9) * step).min(1.0);
        let (from, to) = if to - from >= step / 2.0 {
            (from, to)
        } else if to + step <= 1.0 {
            (from, to + step)
        } else {
            (from - step, to)
        };
        Some(Self {
            from,
            to,
            logarithmic: false,
            cells,
            wanted_ticks: 5.0,
        })
    }

    pub(super) fn cells(&self) -> usize {
        self.cells
    }

    /// Width of a cell, on a linear axis in units of the values.
    pub(super) fn step(&self) -> f64 {
        (self.to - self.from) / (self.cells - 1) as f64
    }

    /// The cell of a value, if it lies on the axis.
    pub(super) fn cell(&self, value: f64) -> Option<usize> {
        let scaled = if self.logarithmic {
            libm::log10(value)
        } else {
            value
        };
        let place = libm::round((scaled - self.from) / self.step());
        // Compared as floats first, so that NaN and values far outside drop out.
        let last = (self.cells - 1) as f64;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        (0.0..=last).contains(&place).then_some(place as usize)
    }

    /// The cell of a value, or the nearest end.
    pub(super) fn clamped_cell(&self, value: f64) -> Option<usize> {
        self.cell(value.clamp(self.from, self.to))
    }

    /// The value in the middle of a cell.
    pub(super) fn value(&self, cell: usize) -> f64 {
        let scaled = self.from + self.step() * cell as f64;
        if self.logarithmic {
            libm::pow(10.0, scaled)
        } else {
            scaled
        }
    }

    /// Ticks at round numbers, from the least up.
    pub(super) fn ticks(&self) -> Vec<Tick> {
        let values = if self.logarithmic {
            self.decades()
        } else {
            self.multiples()
        };
        let mut ticks: Vec<Tick> = Vec::new();
        for value in values {
            if let Some(cell) = self.cell(value)
                && ticks.last().is_none_or(|last| last.cell < cell)
            {
                ticks.push(Tick {
                    cell,
                    label: compact(value),
                });
            }
        }
        ticks
    }

    fn multiples(&self) -> Vec<f64> {
        let step = round_step((self.to - self.from) / self.wanted_ticks);
        let first = libm::ceil(self.from / step - 1e-9);
        let last = libm::floor(self.to / step + 1e-9);
        // At most a few dozen: the range is `wanted_ticks` steps, give or take a factor of 2.5.
        let mut multiple = first;
        let mut values = Vec::new();
        while multiple <= last && values.len() < 100 {
            values.push(multiple * step);
            multiple += 1.0;
        }
        values
    }

    /// Powers of ten, with their doubles and fivefolds where there are few.
    fn decades(&self) -> Vec<f64> {
        // Exponents of f64: a few hundred at most.
        #[allow(clippy::cast_possible_truncation)]
        let (first, last) = (libm::floor(self.from) as i32, libm::ceil(self.to) as i32);
        let factors: &[f64] = if last - first <= 4 {
            &[1.0, 2.0, 5.0]
        } else {
            &[1.0]
        };
        (first..=last)
            .flat_map(|exponent| {
                factors
                    .iter()
                    .map(move |factor| factor * libm::pow(10.0, f64::from(exponent)))
            })
            .collect()
    }
}

/// Least and greatest of the finite values.
fn extent(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values
        .filter(|value| value.is_finite())
        .fold(None, |extent, value| {
            let (least, most) = extent.unwrap_or((value, value));
            Some((value.min(least), value.max(most)))
        })
}

/// The least of 1, 2, 5 times a power of ten that is no smaller than `at_least`.
fn round_step(at_least: f64) -> f64 {
    let power = libm::pow(10.0, libm::floor(libm::log10(at_least)));
    let factor = [1.0, 2.0, 5.0]
        .into_iter()
        .find(|factor| factor * power >= at_least);
    factor.unwrap_or(10.0) * power
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis) -> Vec<String> {
        axis.ticks().into_iter().map(|tick| tick.label).collect()
    }

    #[test]
    fn ends_fall_on_the_first_and_last_cell() {
        let axis = Axis::horizontal([0.5, 2.5, 1.0].into_iter(), 81).unwrap();
        assert_eq!(
            (axis.cell(0.5), axis.cell(2.5), axis.cell(1.5)),
            (Some(0), Some(80), Some(40))
        );
        assert_eq!((axis.cell(0.4), axis.cell(f64::NAN)), (None, None));
        assert_eq!(labels(&axis), ["0.5", "1", "1.5", "2", "2.5"]);
        assert!((axis.value(40) - 1.5).abs() < 1e-12);
    }

    #[test]
    fn a_wide_range_is_logarithmic() {
        let axis = Axis::horizontal([0.01, 100.0].into_iter(), 41).unwrap();
        assert_eq!(axis.cell(1.0), Some(20));
        assert_eq!(labels(&axis).len(), 13);
        let axis = Axis::horizontal([1e-12, 1e12].into_iter(), 49).unwrap();
        assert_eq!(labels(&axis).len(), 25);
    }

    #[test]
    fn probabilities_get_a_round_range_within_0_and_1() {
        let axis = Axis::vertical([0.09, 0.62].into_iter(), 16).unwrap();
        assert_eq!(labels(&axis), ["0", "0.2", "0.4", "0.6", "0.8"]);
        for constant in [0.0, 1.0 / 3.0, 1.0] {
            let axis = Axis::vertical([constant].into_iter(), 16).unwrap();
            assert!(axis.from >= -1e-12 && axis.to <= 1.0 + 1e-12 && axis.from < axis.to);
            assert!(axis.cell(constant).is_some(), "{constant}");
        }
    }

    #[test]
    fn nothing_to_span_is_no_axis() {
        assert!(Axis::horizontal([1.0, 1.0].into_iter(), 10).is_none());
        assert!(Axis::horizontal([f64::NAN, 1.0].into_iter(), 10).is_none());
        assert!(Axis::vertical(std::iter::empty(), 10).is_none());
    }
}

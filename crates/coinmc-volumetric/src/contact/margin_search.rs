//! The search for the time within a step at which the mode ceases to hold.

/// A root search for the margin of a mode along a step.
///
/// It looks at the zero of the chord, shifted slightly to its far side, so that the next look comes
/// from the other side; every third look is at the middle.
pub(super) struct MarginSearch {
    /// Fraction of the step and margin there: where the mode holds, and where it does not.
    low: (f64, f64),
    high: (f64, f64),
    looks: u32,
    /// Whether the mode held at the last look.
    held: bool,
}

impl MarginSearch {
    /// A bracket of this width is narrow enough.
    const WIDTH: f64 = 4e-3;
    /// How far beyond the chord's zero to look.
    const BEYOND: f64 = 1.6e-3;

    /// A search between the start and the end of the step, with the margins there.
    pub(super) fn new(start: f64, end: f64) -> Self {
        Self {
            low: (0.0, start),
            high: (1.0, end),
            looks: 0,
            held: true,
        }
    }

    /// Where to look next, as a fraction of the step; `None` once the bracket is narrow enough.
    pub(super) fn next(&mut self) -> Option<f64> {
        let ((low, above), (high, below)) = (self.low, self.high);
        let width = high - low;
        if width <= Self::WIDTH {
            return None;
        }
        self.looks += 1;
        let zero = low + width * above / (above - below);
        let beyond = if self.held {
            Self::BEYOND
        } else {
            -Self::BEYOND
        };
        let chord = zero + beyond;
        let inside = low < chord && chord < high && !self.looks.is_multiple_of(3);
        Some(if inside { chord } else { low + 0.5 * width })
    }

    /// Narrows the bracket by a look.
    pub(super) fn narrow(&mut self, at: f64, margin: f64, holds: bool) {
        self.held = holds;
        if holds {
            self.low = (at, margin);
        } else {
            self.high = (at, margin);
        }
    }

    /// The end of the bracket where the mode does not hold.
    pub(super) fn end(&self) -> f64 {
        self.high.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The bracket keeps the end of the mode, and is narrow after two or three looks where the margin is almost
    /// straight, as within a step (halving takes eight).
    #[test]
    fn the_end_of_a_mode_is_bracketed_in_few_looks() {
        for (bend, mean) in [(0.0, 3.0), (-0.03, 4.0), (0.03, 4.0)] {
            let mut all = 0;
            for place in 1..100 {
                let end = f64::from(place) / 100.0 + 0.001;
                let margin = |x: f64| (end - x) * (1.0 + bend * x);
                let mut search = MarginSearch::new(margin(0.0), margin(1.0));
                let (mut looks, mut last_held, mut first_lost) = (0, 0.0, 1.0);
                while let Some(at) = search.next() {
                    looks += 1;
                    if margin(at) > 0.0 {
                        last_held = f64::max(last_held, at);
                    } else {
                        first_lost = f64::min(first_lost, at);
                    }
                    search.narrow(at, margin(at), margin(at) > 0.0);
                }
                assert!((search.end() - first_lost).abs() < 1e-15);
                assert!(last_held <= end && end <= first_lost);
                assert!(first_lost - last_held <= MarginSearch::WIDTH);
                all += looks;
            }
            assert!(f64::from(all) <= 99.0 * mean, "{bend}: {all}");
        }
    }
}

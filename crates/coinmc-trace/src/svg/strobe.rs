//! The instants at which the coin is drawn.

use super::units;
use super::view::Shot;

/// Smallest and greatest number of positions in a panel, if there are enough samples.
const MIN: f64 = 8.0;
const MAX: f64 = 40.0;
/// Average distance between positions along the path, in units of the coin's extent.
const SPACED: f64 = 0.6;
/// Opacity of the first position; the last has 1.
const FAINTEST: f64 = 0.45;

/// Selects every `stride`-th sample, at equal time steps, or every `stride`-th event of a trace
/// without samples.
pub(super) struct Strobe {
    stride: usize,
    /// Sampling rate, 1/s; `None` without samples.
    rate_hz: Option<f64>,
}

impl Strobe {
    /// For a path of `path` px and a coin `size` px across.
    pub(super) fn new(seen: &[Shot], path: f64, size: f64, rate_hz: f64) -> Self {
        let samples = seen.iter().filter(|shot| shot.is_sample()).count();
        let rate_hz = (samples > 1 && rate_hz > 0.0).then_some(rate_hz);
        let most = (path / (SPACED * size)).clamp(MIN, MAX);
        let there = if rate_hz.is_some() {
            samples
        } else {
            seen.len()
        };
        Self {
            stride: units::stride(there as f64 / most),
            rate_hz,
        }
    }

    /// The shots to draw and their opacities, in order of time. First and last are among them.
    pub(super) fn positions<'s>(&self, seen: &'s [Shot]) -> Vec<(&'s Shot, f64)> {
        let last = seen.len().saturating_sub(1);
        let positions: Vec<&Shot> = seen
            .iter()
            .enumerate()
            .filter(|(i, shot)| *i == 0 || *i == last || self.is_due(*i, shot))
            .map(|(_, shot)| shot)
            .collect();
        let steps = positions.len().saturating_sub(1).max(1) as f64;
        let opacity = |i: usize| FAINTEST + (1.0 - FAINTEST) * i as f64 / steps;
        let numbered = positions.into_iter().enumerate();
        numbered.map(|(i, shot)| (shot, opacity(i))).collect()
    }

    fn is_due(&self, index: usize, shot: &Shot) -> bool {
        match self.rate_hz {
            None => index.is_multiple_of(self.stride),
            // a sample's number since launch is a whole number except for rounding
            Some(rate_hz) => {
                let steps = libm::round(shot.time_s * rate_hz) / self.stride as f64;
                shot.is_sample() && steps == libm::floor(steps)
            }
        }
    }

    /// "every 20 ms"; empty without samples.
    pub(super) fn describe(&self) -> String {
        match self.rate_hz {
            Some(rate_hz) => format!("every {}", units::time(self.stride as f64 / rate_hz)),
            None => String::new(),
        }
    }
}

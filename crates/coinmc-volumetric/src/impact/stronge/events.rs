//! The first event on a piece of path.

use super::path::{Path, Step};

/// What ended a piece of path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Event {
    /// Only its length.
    End,
    /// u_z = 0: compression is over.
    Turn,
    /// All the work that comes back has come back.
    Over,
    /// ω_x = 0, or what holds it there has reached its limit.
    Roll,
    /// ω_z = 0, or what holds it there has reached its limit.
    Pivot,
}

/// The end of a piece, cut by one event after another.
pub(super) struct Cut<'a> {
    path: &'a Path,
    at: f64,
    /// What the piece adds up to here.
    pub(super) step: Step,
    pub(super) event: Event,
}

/// Evaluations of the bracketing secant; a third of them halve, which alone would be enough.
const MAX_STEPS: u32 = 200;

impl<'a> Cut<'a> {
    pub(super) fn new(path: &'a Path) -> Self {
        Self {
            path,
            at: path.end,
            step: path.step(path.end),
            event: Event::End,
        }
    }

    /// Cuts the piece where `distance`, after a step along it, falls below 0.
    pub(super) fn by(&mut self, event: Event, distance: impl Fn(&Step) -> f64) {
        let end = distance(&self.step);
        if end < 0.0 {
            self.shorten(event, self.at, end, distance);
        }
    }

    /// As [`Cut::by`], for a distance that may come back within the piece: looks halfway first.
    pub(super) fn by_bent(&mut self, event: Event, distance: impl Fn(&Step) -> f64) {
        let half = self.at * 0.5;
        let there = distance(&self.path.step(half));
        if there < 0.0 {
            self.shorten(event, half, there, distance);
        } else {
            self.by(event, distance);
        }
    }

    /// Ends the piece at the root below `high`, where `distance` is `end` < 0.
    // rarer than the looks for it, and there are six
    #[inline(never)]
    fn shorten(&mut self, event: Event, high: f64, end: f64, distance: impl Fn(&Step) -> f64) {
        self.at = first_root(self.path, high, end, distance);
        self.step = self.path.step(self.at);
        self.event = event;
    }
}

/// A root of `distance` between 0 and `high`, where it is `end` < 0: regula falsi with the Illinois
/// modification, halving where that does not shrink the bracket.
fn first_root(path: &Path, mut high: f64, end: f64, distance: impl Fn(&Step) -> f64) -> f64 {
    let mut low = 0.0;
    let mut at_low = distance(&path.step(low));
    let mut at_high = end;
    if at_low.is_nan() || at_low <= 0.0 {
        return low;
    }
    let mut root = high;
    for count in 0..MAX_STEPS {
        let width = high - low;
        let secant = low + width * (at_low / (at_low - at_high));
        // every third step halves, so that the bracket shrinks whatever the function
        let halves = count % 3 == 2;
        root = if !halves && low < secant && secant < high {
            secant
        } else {
            low + 0.5 * width
        };
        let value = distance(&path.step(root));
        if value == 0.0 || width <= 2.0 * f64::EPSILON * high {
            break;
        }
        // the end that stays counts half, so that the next secant overshoots
        if 0.0 < value {
            (low, at_low) = (root, value);
            at_high *= 0.5;
        } else {
            (high, at_high) = (root, value);
            at_low *= 0.5;
        }
    }
    root
}

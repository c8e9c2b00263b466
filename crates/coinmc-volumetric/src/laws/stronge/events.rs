//! The first event on a piece of path.

use super::path::{Path, Step};

/// What ends a piece of path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Event {
    /// Its length.
    Length,
    /// u_z = 0: the end of compression.
    EndOfCompression,
    /// All work that is returned has been returned: the end of the impact.
    EndOfImpact,
    /// ω_x has come to 0, or the friction that keeps it at 0 has reached its limit.
    Roll,
    /// ω_z has come to 0, or the friction that keeps it at 0 has reached its limit.
    Pivot,
}

/// The first event on a piece of path, found by shortening the piece for each kind of event.
pub(super) struct Cut<'a> {
    path: &'a Path,
    at: f64,
    /// What the piece adds up to `at`.
    pub(super) step: Step,
    pub(super) event: Event,
}

/// Most evaluations of the bracketing secant method. A third of them are bisections, which alone
/// would be enough.
const MAX_STEPS: u32 = 200;

impl<'a> Cut<'a> {
    pub(super) fn new(path: &'a Path) -> Self {
        Self {
            path,
            at: path.end,
            step: path.step(path.end),
            event: Event::Length,
        }
    }

    /// Shortens the piece to where `distance`, a function of the step along it, falls below 0.
    pub(super) fn by(&mut self, event: Event, distance: impl Fn(&Step) -> f64) {
        let end = distance(&self.step);
        if end < 0.0 {
            self.shorten(event, self.at, end, distance);
        }
    }

    /// As [`Cut::by`], for a distance that may be positive again at the end of the piece: looks at
    /// the middle first.
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
    // called more rarely than its six callers look for an event
    #[inline(never)]
    fn shorten(&mut self, event: Event, high: f64, end: f64, distance: impl Fn(&Step) -> f64) {
        self.at = first_root(self.path, high, end, distance);
        self.step = self.path.step(self.at);
        self.event = event;
    }
}

/// A root of `distance` between 0 and `high`, where it is `end` < 0: regula falsi with the Illinois
/// modification, and bisection where that does not shrink the bracket.
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
        // every third step is a bisection, so that the bracket shrinks for any function
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
        // the value at the end that stays is halved, so that the next secant overshoots
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

#[cfg(test)]
mod tests {
    use super::super::path::Line;
    use super::*;

    /// A path whose parameter is the normal impulse.
    fn straight(length: f64) -> Path {
        let line = Line {
            x: 0.3,
            y: -0.2,
            normal: -1.1,
            half_gain: 0.7,
        };
        Path::straight(line, length)
    }

    /// The root is found to full precision for flat, steep and broken functions, too, with which secants alone do not
    /// get anywhere.
    #[test]
    fn roots_of_hard_functions_are_found() {
        let path = straight(1.0);
        let functions: [fn(f64) -> f64; 5] = [
            |z| 0.3 - z,
            |z| (0.3 - z).powi(25),
            |z| (0.3 - z).powi(9),
            |z| 1.0 - libm::exp(60.0 * (z - 0.3)),
            |z| if z < 0.3 { 1.0 } else { -1e-12 },
        ];
        for (i, function) in functions.iter().enumerate() {
            let root = first_root(&path, 1.0, function(1.0), |s| function(s.z));
            assert!((root - 0.3).abs() < 1e-12, "function {i}: {root}");
        }
        for never in [-1.0, 0.0, f64::NAN] {
            assert_eq!(first_root(&path, 1.0, -1.0, |_| never), 0.0);
        }
    }

    /// Of several events the first one ends the piece, and what comes later is not seen. A distance that is negative
    /// between only is seen where it bends.
    #[test]
    fn the_first_event_ends_the_piece() {
        let path = straight(2.0);
        let mut cut = Cut::new(&path);
        assert!(cut.event == Event::Length && cut.step.z == 2.0);
        cut.by(Event::EndOfCompression, |s| 1.7 - s.z);
        cut.by(Event::EndOfImpact, |s| 1.9 - s.z);
        assert_eq!(cut.event, Event::EndOfCompression);
        let step = cut.step;
        assert!((step.z - 1.7).abs() < 1e-14);
        assert!((step.x - 0.3 * 1.7).abs() < 1e-14 && (step.y + 0.2 * 1.7).abs() < 1e-14);
        assert!((step.work - (0.7 * 1.7 - 1.1) * 1.7).abs() < 1e-14);
        // below 0 from .6 to 1.2
        let bent = |s: &Step| (s.z - 0.6) * (s.z - 1.2);
        cut.by(Event::Roll, bent);
        assert_eq!(cut.event, Event::EndOfCompression);
        cut.by_bent(Event::Roll, bent);
        assert!(cut.event == Event::Roll && (cut.step.z - 0.6).abs() < 1e-14);
        cut.by_bent(Event::Pivot, |s| 0.5 - s.z);
        assert!(cut.event == Event::Pivot && (cut.step.z - 0.5).abs() < 1e-14);
    }
}

//! The events that end a sliding phase, located exactly.

use super::equations::{RatedState, SlideState};
use crate::shape::{Quadrant, Shape};

/// Margin within which an event counts as reached, in units of D, sqrt(D g) and m g.
const EVENT: f64 = 1e-11;
/// Slip this far backwards counts as zero, in sqrt(D g), so that rounding in the first step does
/// not end a phase that begins at rest, perhaps with zero acceleration.
const REST: f64 = 1e-12;

/// How a sliding phase ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum SlideEnd {
    /// Slip has come to zero.
    Stops,
    /// The contact force has vanished.
    LiftsOff,
    /// The next corner has come down: flat on an edge.
    Flat,
    /// The force that sliding needs grows without bound: Painlevé's configuration.
    Jams,
    /// Energy has fallen below the barrier: the face is decided.
    Decided,
    OutOfSteps,
}

/// The ends that break a margin, in the order of the margins.
const ENDS: [SlideEnd; 3] = [SlideEnd::Stops, SlideEnd::LiftsOff, SlideEnd::Flat];

/// The margins that must stay positive while the phase lasts: slip, contact force, angle to flat.
#[derive(Debug, Clone, Copy)]
pub(super) struct Margins {
    pub(super) shape: Shape,
    pub(super) quadrant: Quadrant,
    /// Sign of the slip.
    pub(super) direction: f64,
}

impl Margins {
    #[inline]
    fn at(&self, y: &SlideState, cos: f64) -> [f64; 3] {
        let [delta, omega, slip, _] = *y;
        [
            self.direction * slip + REST,
            1.0 - omega * omega * cos,
            self.shape.gap(self.quadrant, delta).0,
        ]
    }

    /// d/dt of the margins.
    #[inline]
    fn slopes(&self, at: &RatedState) -> [f64; 3] {
        let [delta, omega, ..] = at.state;
        let (sin, cos) = at.angle;
        let to_end = self.shape.gap(self.quadrant, delta).1;
        [
            self.direction * at.rates[2],
            omega * (omega * omega * sin - 2.0 * at.rates[1] * cos),
            if to_end { -omega } else { omega },
        ]
    }

    /// The margins over a step of length `h`.
    #[inline]
    pub(super) fn over_step(&self, start: &RatedState, end: &RatedState, h: f64) -> StepMargins {
        let before = self.at(&start.state, start.angle.1);
        let after = self.at(&end.state, end.angle.1);
        let (first, last) = (self.slopes(start), self.slopes(end));
        let curve = |which: usize| {
            let slopes = [first[which] * h, last[which] * h];
            Cubic::new([before[which], after[which]], slopes)
        };
        StepMargins {
            after,
            turning: std::array::from_fn(|which| first[which] < 0.0 && last[which] > 0.0),
            curves: std::array::from_fn(curve),
        }
    }
}

/// The margins over a step, interpolated by cubics in its length.
pub(super) struct StepMargins {
    after: [f64; 3],
    /// Whether each falls at the start and rises at the end.
    turning: [bool; 3],
    curves: [Cubic; 3],
}

impl StepMargins {
    /// Where a margin that is positive at both ends of a step dips below zero between them: its
    /// lowest point, as a share of the step. A shorter step should end there.
    #[inline]
    pub(super) fn dip(&self) -> Option<f64> {
        (0..3).find_map(|which| {
            let turns = self.turning[which] && self.after[which] >= 0.0;
            let (share, lowest) = turns.then(|| self.curves[which].lowest())?;
            (lowest < 0.0).then_some(share)
        })
    }

    /// The search for the earliest event within the step that begins at `start`; `None` if there is
    /// no event.
    #[inline]
    pub(super) fn search(&self, start: &RatedState) -> Option<EventSearch> {
        let (which, share) = earliest(&self.curves, &self.after)?;
        Some(EventSearch {
            start: *start,
            curves: self.curves,
            which,
            share,
            last_inside: Trial {
                share: 0.0,
                state: start.state,
                angle: start.angle,
            },
            outside: 1.0,
            trials: 0,
        })
    }
}

/// The margin that is broken first, and where, as a share of the step.
#[inline]
fn earliest(curves: &[Cubic; 3], margins: &[f64; 3]) -> Option<(usize, f64)> {
    (0..3)
        .filter(|which| margins[*which] < 0.0)
        .map(|which| (which, curves[which].root()))
        .min_by(|a, b| a.1.total_cmp(&b.1))
}

/// A search for an event within a step. Each trial is a step of its own from the same start, as
/// accurate as the whole step.
///
/// The first trial is the root of the broken margin's cubic. Newton's method with the slope of the
/// cubic gives the next ones, bisection where that leaves the bracket.
#[derive(Debug, Clone, Copy)]
pub(super) struct EventSearch {
    pub(super) start: RatedState,
    curves: [Cubic; 3],
    /// The margin that is broken first.
    which: usize,
    /// Length of the next trial, as a share of the step.
    pub(super) share: f64,
    /// The longest trial that ends before the event.
    pub(super) last_inside: Trial,
    /// Share of the shortest trial that ends after it.
    outside: f64,
    trials: u32,
}

/// A step of part of the length.
#[derive(Debug, Clone, Copy)]
pub(super) struct Trial {
    pub(super) share: f64,
    pub(super) state: SlideState,
    pub(super) angle: (f64, f64),
}

impl EventSearch {
    /// How the event ends the phase.
    pub(super) fn end(&self) -> SlideEnd {
        ENDS[self.which]
    }

    /// Records where a trial has led, with sine and cosine of the angle there (`None`: the
    /// equations do not hold on the way); `true` if the search is over.
    pub(super) fn record(
        &mut self,
        margins: &Margins,
        to: Option<(SlideState, (f64, f64))>,
    ) -> bool {
        const MAX_TRIALS: u32 = 100;
        self.trials += 1;
        let Some((state, angle)) = to else {
            return true;
        };
        let at = margins.at(&state, angle.1);
        if at.iter().all(|margin| *margin >= 0.0) {
            self.last_inside = Trial {
                share: self.share,
                state,
                angle,
            };
            if at[self.which] <= EVENT {
                return true;
            }
        } else {
            self.outside = self.share;
            if at[self.which] >= 0.0 {
                let first = earliest(&self.curves, &at);
                self.which = first.map_or(self.which, |(which, _)| which);
            }
        }
        if self.outside - self.last_inside.share <= EVENT || self.trials == MAX_TRIALS {
            return true;
        }
        // aim just inside the margin, so that the last trial can be kept
        let slope = self.curves[self.which].slope(self.share);
        let newton = self.share - (at[self.which] - 0.5 * EVENT) / slope;
        let bracketed = newton > self.last_inside.share && newton < self.outside;
        self.share = if bracketed {
            newton
        } else {
            f64::midpoint(self.last_inside.share, self.outside)
        };
        false
    }
}

/// c₀ + c₁t + c₂t² + c₃t³ on [0, 1].
#[derive(Debug, Clone, Copy)]
struct Cubic([f64; 4]);

impl Cubic {
    /// From its values and slopes at the ends (Hermite).
    fn new([v0, v1]: [f64; 2], [s0, s1]: [f64; 2]) -> Self {
        let rise = v1 - v0;
        Self([v0, s0, 3.0 * rise - 2.0 * s0 - s1, s0 + s1 - 2.0 * rise])
    }

    fn value(&self, t: f64) -> f64 {
        let [c0, c1, c2, c3] = self.0;
        c0 + t * (c1 + t * (c2 + t * c3))
    }

    fn slope(&self, t: f64) -> f64 {
        let [_, c1, c2, c3] = self.0;
        c1 + t * (2.0 * c2 + t * 3.0 * c3)
    }

    /// Where it is lowest and its value there, given a slope that is negative at 0 and positive at
    /// 1.
    fn lowest(&self) -> (f64, f64) {
        let [_, c1, c2, c3] = self.0;
        // c1 < 0 < c1 + 2c2 + 3c3: the root of the slope at which it rises, without cancellation
        let t = -c1 / (c2 + (c2 * c2 - 3.0 * c1 * c3).max(0.0).sqrt());
        (t, self.value(t))
    }

    /// A root, given a value of at least zero at 0 and below zero at 1. A few halvings and a Newton
    /// step are enough to start the search.
    fn root(&self) -> f64 {
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..6 {
            let middle = f64::midpoint(low, high);
            *(if self.value(middle) >= 0.0 {
                &mut low
            } else {
                &mut high
            }) = middle;
        }
        let middle = f64::midpoint(low, high);
        (middle - self.value(middle) / self.slope(middle)).clamp(low, high)
    }
}

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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::slide::equations::Sliding;
    use coinmc_lanes::sin_cos;
    use coinmc_testkit::scene;

    fn margins(quadrant: Quadrant, direction: f64) -> Margins {
        let shape = Shape::new(&scene(1.0, 0.0, 0.3).coin);
        Margins {
            shape,
            quadrant,
            direction,
        }
    }

    /// t³ − 1.2t² + 0.21t + 0.5, whose slope 3(t − 0.1)(t − 0.7) is zero where it is highest and lowest.
    #[test]
    fn a_cubic_is_found_from_its_ends() {
        let value = |t: f64| t * t * t - 1.2 * t * t + 0.21 * t + 0.5;
        let slope = |t: f64| 3.0 * (t - 0.1) * (t - 0.7);
        let cubic = Cubic::new([value(0.0), value(1.0)], [slope(0.0), slope(1.0)]);
        for t in [0.0, 0.2, 0.5, 0.9, 1.0] {
            assert!((cubic.value(t) - value(t)).abs() < 1e-15);
            assert!((cubic.slope(t) - slope(t)).abs() < 1e-14);
        }
    }

    /// 2(t + 0.5)(t − 0.6) is the slope of the first, −2(t − 0.6)(t − 1.5) of the second: falling at 0, rising at 1.
    #[test]
    fn a_cubic_that_turns_has_its_lowest_point() {
        for (factor, other) in [(2.0, -0.5), (-2.0, 1.5)] {
            let slope = |t: f64| factor * (t - other) * (t - 0.6);
            let value = |t: f64| {
                let linear = other * 0.6 * t;
                0.4 + factor * (t * t * t / 3.0 - (other + 0.6) * t * t / 2.0 + linear)
            };
            assert!(slope(0.0) < 0.0 && slope(1.0) > 0.0);
            let cubic = Cubic::new([value(0.0), value(1.0)], [slope(0.0), slope(1.0)]);
            let (t, lowest) = cubic.lowest();
            assert!((t - 0.6).abs() < 1e-14, "{t}");
            assert!((lowest - value(0.6)).abs() < 1e-14);
        }
    }

    /// Slip in its direction, the force on a corner over that at rest (1 − ω² cos δ), and the angle to flat.
    #[test]
    fn margins_are_slip_force_and_angle_to_flat() {
        let margins = margins(0, -1.0);
        let flat = margins.shape.last_angle(0, 1.0);
        let delta = flat - 0.125;
        let found = margins.at(&[delta, 0.5, -0.25, 9.0], sin_cos(delta).1);
        let expected = [0.25, 1.0 - 0.25 * libm::cos(delta), 0.125];
        for (found, expected) in found.into_iter().zip(expected) {
            assert!((found - expected).abs() < 2.0 * REST);
        }
    }

    /// The slopes are the derivatives of the margins along the motion, on both sides of the balance.
    #[test]
    fn slopes_are_derivatives_of_the_margins() {
        for direction in [1.0, -1.0] {
            for (delta, omega) in [(-0.5, 0.6), (-0.5, -0.6), (0.3, 0.6), (0.3, -0.6)] {
                let margins = margins(0, direction);
                let sliding = Sliding {
                    k: margins.shape.k,
                    friction: 0.3 * direction,
                };
                let start = [delta, omega, 0.7 * direction, 0.0];
                let (at, _) = sliding.at(&start);
                let slopes = margins.slopes(&at);
                let step = 1e-5;
                let moved = |h: f64| {
                    let y = std::array::from_fn(|i| start[i] + h * at.rates[i]);
                    margins.at(&y, sin_cos(y[0]).1)
                };
                let (before, after) = (moved(-step), moved(step));
                for which in 0..3 {
                    // the error of a central difference is of order step²
                    let slope = (after[which] - before[which]) / (2.0 * step);
                    assert!((slopes[which] - slope).abs() < 1e-8, "margin {which}");
                }
            }
        }
    }

    /// A state of a corner that slides at `slip` and speeds up at `rate`.
    fn slipping(slip: f64, rate: f64) -> RatedState {
        RatedState {
            state: [-0.5, 0.0, slip, 0.0],
            rates: [0.0, 0.0, rate, 0.0],
            angle: sin_cos(-0.5),
        }
    }

    /// A slip of 0.1 − t + t² would be negative half way, −0.15; one of 0.3 − t + t² would not, nor would one that
    /// falls all the way. One that ends below zero has an event, not a dip.
    #[test]
    fn a_margin_that_dips_within_a_step_has_its_lowest_point() {
        let margins = margins(0, 1.0);
        let dip = |start: (f64, f64), end: (f64, f64)| {
            // in a step of length 2 the slopes of the share are twice the rates
            let (start, end) = (slipping(start.0, start.1), slipping(end.0, end.1));
            margins.over_step(&start, &end, 2.0).dip()
        };
        let found = dip((0.1, -0.5), (0.1, 0.5)).expect("it dips");
        assert!((found - 0.5).abs() < 1e-12);
        assert_eq!(dip((0.3, -0.5), (0.3, 0.5)), None);
        assert_eq!(dip((0.3, -0.5), (0.1, 0.0)), None);
        assert_eq!(dip((0.1, -0.5), (-0.1, 0.5)), None);
    }

    /// A margin of zero holds; of two that are broken the one whose root comes first counts.
    #[test]
    fn the_earliest_of_the_broken_margins_counts() {
        let line = |from: f64, to: f64| Cubic::new([from, to], [to - from; 2]);
        let curves = [line(1.0, 0.0), line(1.0, -1.0), line(1.0, -3.0)];
        let broken = |margins: &[f64; 3]| earliest(&curves, margins).map(|(which, _)| which);
        assert_eq!(broken(&[0.0, 1.0, 1.0]), None);
        assert_eq!(broken(&[0.0, -1.0, 1.0]), Some(1));
        assert_eq!(broken(&[0.0, -1.0, -3.0]), Some(2));
        let (_, root) = earliest(&curves, &[0.0, -1.0, 1.0]).expect("it is broken");
        assert!((root - 0.5).abs() < 1e-12);
    }

    /// The state a share of the step on, if slip falls as 1 − 2^(t − 1)·c from the start.
    fn fall(c: f64, share: f64) -> RatedState {
        let power = c * libm::exp2(share - 1.0);
        slipping(1.0 - power, -std::f64::consts::LN_2 * power)
    }

    /// Slip that falls along an exponential to zero is followed there by a few trials, to the margin's tolerance.
    #[test]
    fn an_event_is_found_in_a_few_trials() {
        let margins = margins(0, 1.0);
        for c in [1.05, 1.4, 1.9] {
            let (start, end) = (fall(c, 0.0), fall(c, 1.0));
            let step = margins.over_step(&start, &end, 1.0);
            let mut search = step.search(&start).expect("it stops");
            assert_eq!(search.end(), SlideEnd::Stops);
            let trial = |share: f64| {
                let state = fall(c, share).state;
                Some((state, sin_cos(state[0])))
            };
            while !search.record(&margins, trial(search.share)) {}
            let exact = 1.0 - libm::log2(c);
            let found = search.last_inside.share;
            assert!(found < exact + 2.0 * REST && exact - found < 2.0 * EVENT);
            assert!(search.trials <= 6, "{}", search.trials);
        }
    }

    /// Where the margin jumps, the bracket is halved until it is as narrow as the tolerance: 37 times.
    #[test]
    fn a_search_ends_when_its_bracket_has_closed() {
        let margins = margins(0, 1.0);
        let (start, end) = (fall(1.4, 0.0), fall(1.4, 1.0));
        let step = margins.over_step(&start, &end, 1.0);
        let mut search = step.search(&start).expect("it stops");
        let trial = |share: f64| {
            let slip = if share < 0.3 { 10.0 } else { -10.0 };
            let state = slipping(slip, 0.0).state;
            Some((state, sin_cos(state[0])))
        };
        while !search.record(&margins, trial(search.share)) {}
        let found = search.last_inside.share;
        assert!(found < 0.3 && 0.3 - found <= EVENT);
        assert!(search.trials < 50, "{}", search.trials);
    }

    /// (1 - 2t)(t + 0.7)(t - 1.9), whose only root in [0, 1] is 1/2, and its like with a root at 0.3: Newton's step from
    /// within 1/128 of a root errs by no more than the square of that times the curvature over twice the slope.
    #[test]
    fn a_cubic_that_falls_below_zero_has_its_root() {
        for root in [0.5, 0.3, 0.01, 0.99] {
            let value = |t: f64| (t - root) * (t + 0.7) * (t - 1.9);
            let slope =
                |t: f64| (t + 0.7) * (t - 1.9) + (t - root) * (t - 1.9) + (t - root) * (t + 0.7);
            let cubic = Cubic::new([value(0.0), value(1.0)], [slope(0.0), slope(1.0)]);
            assert!(value(0.0) > 0.0 && value(1.0) < 0.0);
            let curvature = 2.0 * (3.0 * root + 0.7 - 1.9 - root).abs() + 6.0 / 128.0;
            let within = curvature / (2.0 * slope(root).abs()) / (128.0 * 128.0);
            let error = (cubic.root() - root).abs();
            assert!(error < 1.5 * within, "{root}: {error} {within}");
        }
    }
}

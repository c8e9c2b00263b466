//! What ends a sliding phase, and exactly when.

use super::SlideEnd;
use super::equations::{Arrival, Slide, Sliding};
use crate::shape::{Quadrant, Shape};
use coinmc_core::trig::sin_cos;

/// How near to its event a phase ends, in units of D, sqrt(D g) and m g.
const EVENT: f64 = 1e-11;
/// Slip this far backwards counts as zero, in sqrt(D g): a phase that begins at rest, perhaps with
/// zero acceleration, is not ended by the rounding of its first step.
const REST: f64 = 1e-12;

const ENDS: [SlideEnd; 3] = [SlideEnd::Stops, SlideEnd::LiftsOff, SlideEnd::Flat];

/// What must stay positive for the phase to go on: slip, contact force, distance to flat.
pub(super) struct Margins<'a> {
    pub(super) shape: &'a Shape,
    pub(super) quadrant: Quadrant,
    /// Sign of the slip.
    pub(super) direction: f64,
}

impl Margins<'_> {
    #[inline]
    fn at(&self, y: &Slide) -> [f64; 3] {
        let [delta, omega, slip, _] = *y;
        [
            self.direction * slip + REST,
            1.0 - omega * omega * sin_cos(delta).1,
            self.shape.gap(self.quadrant, delta).0,
        ]
    }

    /// d/dt of margin number `which`.
    #[inline]
    fn slope(&self, which: usize, at: &Arrival) -> f64 {
        let [delta, omega, ..] = at.state;
        match which {
            0 => self.direction * at.rates[2],
            1 => {
                let (sin, cos) = sin_cos(delta);
                omega * (omega * omega * sin - 2.0 * at.rates[1] * cos)
            }
            _ if self.shape.gap(self.quadrant, delta).1 => -omega,
            _ => omega,
        }
    }

    /// Where a margin that is positive at both ends of an accepted step dips below zero between
    /// them: the time of its lowest point, at which a shorter step should end. Judged by the
    /// cubic through both ends.
    #[inline]
    pub(super) fn dip(&self, start: &Arrival, end: &Arrival, h: f64) -> Option<f64> {
        let (before, after) = (self.at(&start.state), self.at(&end.state));
        (0..3).find_map(|which| {
            let slopes = [self.slope(which, start) * h, self.slope(which, end) * h];
            let turns = slopes[0] < 0.0 && slopes[1] > 0.0 && after[which] >= 0.0;
            let lowest =
                turns.then(|| Cubic::new([before[which], after[which]], slopes).lowest())?;
            (lowest.1 < 0.0).then_some(lowest.0 * h)
        })
    }

    /// The earliest event within an accepted step of length `h`, or `None`: after which time, in
    /// which state, which end.
    ///
    /// The broken margin is interpolated by a cubic in the length of the step; its root is the
    /// first trial, Newton with the cubic's slope gives the next ones, a bisection where that
    /// leaves the bracket. Each trial is a true step from `start`, as accurate as the step itself.
    #[inline]
    pub(super) fn first_event(
        &self,
        sliding: &Sliding,
        start: &Arrival,
        end: &Arrival,
        h: f64,
    ) -> Option<(f64, Slide, SlideEnd)> {
        let (before, after) = (self.at(&start.state), self.at(&end.state));
        if after.iter().all(|margin| *margin >= 0.0) {
            return None;
        }
        let cubic = |which: usize| {
            let slopes = [self.slope(which, start) * h, self.slope(which, end) * h];
            Cubic::new([before[which], after[which]], slopes)
        };
        let earliest = |margins: &[f64; 3]| {
            (0..3)
                .filter(|which| margins[*which] < 0.0)
                .map(|which| (which, cubic(which).root()))
                .min_by(|a, b| a.1.total_cmp(&b.1))
        };
        let (mut which, mut share) = earliest(&after)?;
        let mut curve = cubic(which);
        let (mut inside, mut outside) = ((0.0, start.state), 1.0);
        for _ in 0..100 {
            let Some((state, _)) = sliding.step(start, share * h) else {
                break;
            };
            let margins = self.at(&state);
            if margins.iter().all(|margin| *margin >= 0.0) {
                inside = (share, state);
                if margins[which] <= EVENT {
                    break;
                }
            } else {
                outside = share;
                if margins[which] >= 0.0 {
                    which = earliest(&margins).map_or(which, |(other, _)| other);
                    curve = cubic(which);
                }
            }
            if outside - inside.0 <= EVENT {
                break;
            }
            // aims just inside the margin, so that the last trial can be kept
            let newton = share - (margins[which] - 0.5 * EVENT) / curve.slope(share);
            let bracketed = newton > inside.0 && newton < outside;
            share = if bracketed {
                newton
            } else {
                f64::midpoint(inside.0, outside)
            };
        }
        Some((inside.0 * h, inside.1, ENDS[which]))
    }
}

/// c₀ + c₁t + c₂t² + c₃t³ on [0, 1].
struct Cubic([f64; 4]);

impl Cubic {
    /// By its values and slopes at the ends (Hermite).
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

    /// Where it is lowest and how low, given a slope that is negative at 0 and positive at 1.
    fn lowest(&self) -> (f64, f64) {
        let [_, c1, c2, c3] = self.0;
        // c1 < 0 < c1 + 2c2 + 3c3: the root of the slope at which it rises, without cancellation
        let t = -c1 / (c2 + (c2 * c2 - 3.0 * c1 * c3).max(0.0).sqrt());
        (t, self.value(t))
    }

    /// A root, given values of at least zero at 0 and below zero at 1: a few halvings and a
    /// Newton step, since it only starts what follows.
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

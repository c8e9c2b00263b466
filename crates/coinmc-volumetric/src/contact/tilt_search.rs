//! The search for the length of the step that ends where another rim point touches.

use super::phase::{Exit, Phase, PhaseTransition};
use super::rim::{OMEGA_Y, RimState, TILT};
use super::step::SIDE_ANGLE;
use crate::motion::FLAT;

/// Most tries of a search; bisection alone needs as many.
const MOST_TRIES: u32 = 40;

/// Newton's method in a bracket for the step length at which the tilt reaches a goal. Each
/// evaluation is one try of the step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TiltSearch {
    goal: f64,
    /// The exit at the goal.
    exit: Exit,
    low: f64,
    high: f64,
    /// Length of the last try, or of the next one.
    pub(crate) length: f64,
    tries: u32,
}

impl TiltSearch {
    /// The search, if the step of this length from `phase` to `state` passes a goal: level, or the
    /// tilt `side`.
    #[inline]
    pub(crate) fn within(
        phase: &Phase,
        state: &RimState<f64>,
        length: f64,
        side: f64,
    ) -> Option<Self> {
        let tilt = state[TILT];
        let arrives = tilt > side - SIDE_ANGLE && state[OMEGA_Y] > 0.0;
        // a tilt beyond the side has passed it within the step, even if it decreases again
        let (goal, exit) = if arrives || tilt > side + SIDE_ANGLE {
            (side, Exit::OtherRim)
        } else if tilt < FLAT && phase.state[TILT] > FLAT {
            (FLAT, Exit::Level)
        } else {
            return None;
        };
        Some(Self {
            goal,
            exit,
            low: 0.0,
            high: length,
            length,
            tries: 0,
        })
    }

    /// Whether the last try, which led to `state`, missed the goal; `length` is that of the next
    /// try then.
    pub(crate) fn needs_another_try(&mut self, state: &RimState<f64>) -> bool {
        let gap = state[TILT] - self.goal;
        if self.tries == MOST_TRIES || gap.abs() <= SIDE_ANGLE {
            return false;
        }
        self.tries += 1;
        // the side of the goal where the phase is (it may start at the goal itself, and come back)
        let before = if self.exit == Exit::OtherRim {
            -1.0
        } else {
            1.0
        };
        if gap * before > 0.0 {
            self.low = self.length;
        } else {
            self.high = self.length;
        }
        let newton = self.length - gap / state[OMEGA_Y];
        self.length = if newton > self.low && newton < self.high {
            newton
        } else {
            0.5 * (self.low + self.high)
        };
        true
    }

    /// Ends the step at the goal; returns the exit and the length of the step.
    pub(crate) fn finish(
        &self,
        phase: &mut Phase,
        mut state: RimState<f64>,
    ) -> (PhaseTransition, f64) {
        state[TILT] = self.goal;
        phase.state = state;
        (PhaseTransition::Leave(self.exit), self.length)
    }
}

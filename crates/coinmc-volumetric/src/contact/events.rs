//! What happens within a step of contact: a point of a rim comes down, or the mode no longer holds.

use super::attempt::{DOWN, YIELD, can_stick, holds, slip_speed, swings_over};
use super::follow::{Contact, FLAT, Leave, Next, Phase, RESEED, SEED};
use super::integrator::Trial;
use super::rim::{Mode, OMEGA_Y, Rates, RimState, TILT};
use super::state::change_slip;
use std::f64::consts::FRAC_PI_2;

/// Turning points of the tilt after which a conserving motion is seen to repeat itself.
const TURNING_POINTS: u32 = 3;
/// Steps of Newton's method to where a point comes down; halving alone needs as many.
const MOST_TRIES: u32 = 40;

/// The search for the length of the step that ends where the tilt reaches a goal: Newton's method
/// in a bracket, each evaluation an attempt at the step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reach {
    goal: f64,
    leave: Leave,
    low: f64,
    high: f64,
    /// Of the last attempt, and of the next.
    pub(crate) length: f64,
    tries: u32,
}

impl Reach {
    /// The search, if the step of `length` from `phase` to `state` passes a goal.
    #[inline]
    pub(crate) fn of(phase: &Phase, state: &RimState<f64>, length: f64) -> Option<Self> {
        let tilt = state[TILT];
        let falls_on = tilt > FRAC_PI_2 - DOWN && state[OMEGA_Y] > 0.0;
        // beyond, it has come down within the step, even if it has turned round since
        let (goal, leave) = if falls_on || tilt > FRAC_PI_2 + DOWN {
            (FRAC_PI_2, Leave::OtherRim)
        } else if tilt < FLAT && phase.state[TILT] > FLAT {
            (FLAT, Leave::Upright)
        } else {
            return None;
        };
        Some(Self {
            goal,
            leave,
            low: 0.0,
            high: length,
            length,
            tries: 0,
        })
    }

    /// Whether the last attempt, which led to `state`, is not there yet: then the next is to be
    /// made.
    pub(crate) fn is_away(&mut self, state: &RimState<f64>) -> bool {
        let gap = state[TILT] - self.goal;
        if self.tries == MOST_TRIES || gap.abs() <= DOWN {
            return false;
        }
        self.tries += 1;
        // the side the phase is on: it may start at the goal itself, going away and coming back
        let before = if self.leave == Leave::OtherRim {
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

    /// Ends the step there; how long it was.
    pub(crate) fn arrive(&self, phase: &mut Phase, mut state: RimState<f64>) -> (Next, f64) {
        state[TILT] = self.goal;
        phase.state = state;
        (Next::End(self.leave), self.length)
    }
}

impl Contact<'_> {
    /// Sees whether an accepted step passes an event; if so the phase goes to the event instead.
    pub(crate) fn accept(
        &mut self,
        phase: &mut Phase,
        trial: &Trial<f64, 6>,
        now: &Rates<f64>,
        length: f64,
        wanted: f64,
    ) -> (Next, f64) {
        if let Some(reach) = Reach::of(phase, &trial.state, length) {
            return self.reach(phase, reach, trial.state);
        }
        // the other rim may also have come down within the step and be up again at its end
        if swings_over(
            phase.state[TILT],
            phase.state[OMEGA_Y],
            trial.state[OMEGA_Y],
            length,
        ) {
            let (fraction, state) = turning_point(phase, trial);
            if let Some(reach) = Reach::of(phase, &state, fraction * length) {
                return self.reach(phase, reach, state);
            }
        }
        if holds(self.law, phase.mode, now) {
            if trial.state[OMEGA_Y] * phase.state[OMEGA_Y] < 0.0 {
                phase.turning_points += 1;
            }
            phase.state = trial.state;
            phase.now = *now;
            phase.length = wanted;
            return (self.after_step(phase), length);
        }
        let (fraction, state, now) = self.locate(phase, trial);
        if let Some(reach) = Reach::of(phase, &state, fraction * length) {
            return self.reach(phase, reach, state);
        }
        phase.state = state;
        phase.now = now;
        phase.length = wanted;
        let next = if now.press <= 0.0 {
            Next::End(Leave::LiftOff)
        } else if phase.mode == Mode::Slip && now.yields < YIELD {
            self.jammed(phase)
        } else {
            Next::Change
        };
        (next, fraction * length)
    }

    /// Goes to where the tilt reaches its goal, from an attempt that led beyond it to `state`.
    fn reach(
        &mut self,
        phase: &mut Phase,
        mut reach: Reach,
        mut state: RimState<f64>,
    ) -> (Next, f64) {
        while reach.is_away(&state) {
            self.spent.steps += 1;
            state = self.attempt(phase, reach.length).0.state;
        }
        reach.arrive(phase, state)
    }

    /// The first moment of the step at which the mode no longer holds, by bisection of the dense
    /// output: its own error is that of the step, so a thousandth of the step is close enough.
    fn locate(&self, phase: &Phase, trial: &Trial<f64, 6>) -> (f64, RimState<f64>, Rates<f64>) {
        let (mut low, mut high) = (0.0, 1.0);
        let mut found = (trial.state, self.law.rates(&trial.state, phase.mode));
        while high - low > 1e-3 {
            let middle = 0.5 * (low + high);
            let state = trial.between(&phase.state, middle);
            let now = self.law.rates(&state, phase.mode);
            if holds(self.law, phase.mode, &now) {
                low = middle;
            } else {
                high = middle;
                found = (state, now);
            }
        }
        (high, found.0, found.1)
    }

    fn after_step(&self, phase: &Phase) -> Next {
        if self.law.conserves(phase.mode) && phase.turning_points >= TURNING_POINTS {
            return Next::End(Leave::Endless);
        }
        if phase.mode == Mode::Slip && self.is_stopping(phase) {
            Next::Change
        } else {
            Next::Go
        }
    }

    /// Whether a sliding phase has come to where it sticks, or its direction is lost.
    fn is_stopping(&self, phase: &Phase) -> bool {
        let state = &phase.state;
        let slip = slip_speed(state);
        let [.., gx, gy] = *state;
        let [.., ax, ay] = phase.now.state;
        if self.law.friction.mu == 0.0 || slip > self.settings.stick || gx * ax + gy * ay >= 0.0 {
            return false;
        }
        let held = change_slip(self.law, state, 0.0, 0.0);
        slip < RESEED * SEED * self.settings.stick
            || can_stick(self.law, &self.law.rates(&held, Mode::Stick))
    }
}

/// Where in a step the tilt is largest, by bisection of the dense output.
fn turning_point(phase: &Phase, trial: &Trial<f64, 6>) -> (f64, RimState<f64>) {
    let (mut low, mut high) = (0.0, 1.0);
    while high - low > 1e-3 {
        let middle = 0.5 * (low + high);
        if trial.between(&phase.state, middle)[OMEGA_Y] > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    (high, trial.between(&phase.state, high))
}

//! Events within an accepted step of contact: another rim point touches, or the mode ceases to
//! hold.

use super::integrator::Trial;
use super::margin_search::MarginSearch;
use super::phase::{Exit, Phase, PhaseTransition};
use super::rim::{Mode, OMEGA_Y, Rates, RimState, TILT};
use super::solver::{ContactSolver, INITIAL_SLIP, RESTART_SLIP};
use super::state::change_slip;
use super::step::{
    LEAST_JAM_MARGIN, SIDE_ANGLE, can_stick, holds, margin, may_reach_side, slip_speed,
};
use super::tilt_search::TiltSearch;
use coinmc_core::Decided;

/// After this many turning points of the tilt, a motion without loss has shown that it repeats
/// itself.
const TURNING_POINTS: u32 = 3;
/// An extreme of the tilt closer to the balance than this, in u_z, may lie on either side of it: a
/// hundred times the error of the dense output.
const BALANCE_ERROR: f64 = 1e-4;
/// Precision of a turning point, as a fraction of the step.
const TURNING_POINT_WIDTH: f64 = 1e-3;

impl ContactSolver<'_> {
    /// Moves `phase` to the end of an accepted step, or to the first event within it. Returns the
    /// transition there, and the duration.
    pub(crate) fn accept(
        &mut self,
        phase: &mut Phase,
        trial: &Trial<f64, 6>,
        now: &Rates<f64>,
        length: f64,
        wanted: f64,
    ) -> (PhaseTransition, f64) {
        let side = self.rules.side;
        if let Some(mut search) = TiltSearch::within(phase, &trial.state, length, side) {
            let state = self.finish_tries(phase, &mut search, trial.state);
            return search.finish(phase, state);
        }
        // the other rim may also have touched within the step and have risen again at its end
        let (before, after) = (phase.state[OMEGA_Y], trial.state[OMEGA_Y]);
        if may_reach_side(phase.state[TILT], before, after, length, side) {
            let (fraction, state) = turning_point(phase, trial);
            if let Some(touching) = self.touch_before(phase, &state, fraction * length) {
                return touching;
            }
        }
        if !holds(self.rules.dynamics, phase.mode, now) {
            return self.end_mode(phase, trial, now, length, wanted);
        }
        if self.rules.dynamics.conserves(phase.mode) && before * after < 0.0 {
            let (_, state) = turning_point(phase, trial);
            phase.count_turning_point(state[TILT]);
        }
        phase.state = trial.state;
        phase.now = *now;
        phase.length = wanted;
        (self.after_step(phase), length)
    }

    /// Moves `phase` to where its mode ceases to hold within the step, or where the other rim
    /// touches before.
    fn end_mode(
        &mut self,
        phase: &mut Phase,
        trial: &Trial<f64, 6>,
        now: &Rates<f64>,
        length: f64,
        wanted: f64,
    ) -> (PhaseTransition, f64) {
        let (fraction, state, now) = self.locate_end_of_mode(phase, trial, now);
        if let Some(touching) = self.touch_before(phase, &state, fraction * length) {
            return touching;
        }
        phase.state = state;
        phase.state[TILT] = phase.state[TILT].min(self.rules.side);
        phase.now = now;
        phase.length = wanted;
        let next = if now.press <= 0.0 {
            PhaseTransition::Leave(Exit::LiftOff)
        } else if phase.mode == Mode::Slip && now.jam_margin < LEAST_JAM_MARGIN {
            self.resolve_jam(phase)
        } else {
            PhaseTransition::ChangeMode
        };
        (next, fraction * length)
    }

    /// Tries the step with other lengths, after a try that led to `state`, until the tilt is at its
    /// goal. Returns the state there.
    fn finish_tries(
        &mut self,
        phase: &Phase,
        search: &mut TiltSearch,
        mut state: RimState<f64>,
    ) -> RimState<f64> {
        while search.needs_another_try(&state) {
            self.usage.steps += 1;
            state = self.try_step(phase, search.length).0.state;
        }
        state
    }

    /// Moves `phase` to where the other rim touches on the way to `state`. The dense output puts
    /// `state` at a time `length` into the step. `None` if the rim does not touch: the tilt may
    /// exceed the side only by the error of the dense output.
    fn touch_before(
        &mut self,
        phase: &mut Phase,
        state: &RimState<f64>,
        length: f64,
    ) -> Option<(PhaseTransition, f64)> {
        let side = self.rules.side;
        if state[TILT] <= side + SIDE_ANGLE {
            return None;
        }
        let mut search = TiltSearch::within(phase, state, length, side)?;
        let state = self.finish_tries(phase, &mut search, *state);
        let arrives = (state[TILT] - side).abs() <= SIDE_ANGLE && state[OMEGA_Y] > 0.0;
        arrives.then(|| search.finish(phase, state))
    }

    /// A time at which the mode no longer holds, shortly after one at which it does: the fraction
    /// of the step, the state and the rates. It is found in the dense output. Because that has the
    /// same error as the step, a precision of a few thousandths of the step is enough.
    fn locate_end_of_mode(
        &self,
        phase: &Phase,
        trial: &Trial<f64, 6>,
        now: &Rates<f64>,
    ) -> (f64, RimState<f64>, Rates<f64>) {
        let dynamics = self.rules.dynamics;
        let margin = |now: &Rates<f64>| margin(dynamics, phase.mode, now);
        let before = dynamics.rates(&phase.state, phase.mode);
        let mut search = MarginSearch::new(margin(&before), margin(now));
        let mut found = (trial.state, *now);
        while let Some(at) = search.next() {
            let state = trial.between(&phase.state, at);
            let now = dynamics.rates(&state, phase.mode);
            let holds = holds(dynamics, phase.mode, &now);
            search.narrow(at, margin(&now), holds);
            if !holds {
                found = (state, now);
            }
        }
        (search.end(), found.0, found.1)
    }

    /// The transition at the end of a step in which the mode holds.
    fn after_step(&self, phase: &Phase) -> PhaseTransition {
        if phase.turning_points >= TURNING_POINTS {
            return PhaseTransition::Leave(self.exit_of_repetition(phase));
        }
        if phase.mode == Mode::Slip && self.slip_ends(phase) {
            PhaseTransition::ChangeMode
        } else {
            PhaseTransition::Stay
        }
    }

    /// The exit of a motion that repeats itself. The tilt stays between its extremes forever. If
    /// both lie in one well, that decides the face, unless only the energy may decide it.
    fn exit_of_repetition(&self, phase: &Phase) -> Exit {
        // u_z is largest where the tilt is smallest
        let [highest, lowest] = phase.tilts.map(libm::cos);
        let half = self.rules.rule.balance();
        if !self.rules.rule.is_tilting() {
            Exit::NeverSettles
        } else if highest < half - BALANCE_ERROR {
            Exit::Decided(Decided::Side)
        } else if lowest > half + BALANCE_ERROR {
            Exit::Decided(Decided::Face)
        } else {
            Exit::NeverSettles
        }
    }

    /// Whether a slip has come to where the point sticks, or to where its direction is lost.
    fn slip_ends(&self, phase: &Phase) -> bool {
        let (dynamics, stick_speed) = (self.rules.dynamics, self.rules.stick_speed);
        let state = &phase.state;
        let slip = slip_speed(state);
        let [.., gx, gy] = *state;
        let [.., ax, ay] = phase.now.state;
        if dynamics.friction.mu == 0.0 || slip > stick_speed || gx * ax + gy * ay >= 0.0 {
            return false;
        }
        let sticking = change_slip(dynamics, state, 0.0, 0.0);
        slip < RESTART_SLIP * INITIAL_SLIP * stick_speed
            || can_stick(dynamics, &dynamics.rates(&sticking, Mode::Stick))
    }
}

/// Where in a step the tilt turns, as a fraction of the step, and the state there: by bisection of
/// the dense output.
fn turning_point(phase: &Phase, trial: &Trial<f64, 6>) -> (f64, RimState<f64>) {
    let rises = phase.state[OMEGA_Y] > 0.0;
    let (mut low, mut high) = (0.0, 1.0);
    while high - low > TURNING_POINT_WIDTH {
        let middle = 0.5 * (low + high);
        if (trial.between(&phase.state, middle)[OMEGA_Y] > 0.0) == rises {
            low = middle;
        } else {
            high = middle;
        }
    }
    (high, trial.between(&phase.state, high))
}

#[cfg(test)]
mod tests;

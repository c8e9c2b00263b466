//! The scalar path through contact on one rim point.

use super::integrator::{is_accepted, shorter, step};
use super::phase::{Exit, Phase, PhaseTransition, StepStart};
use super::rim::{Mode, TILT};
use super::solver::ContactSolver;
use super::state::place_below;
use super::step::{step_limit, wanted_length};
use crate::motion::{Motion, Spin};
use crate::observer_adapter::ObserverAdapter;
use coinmc_core::{EventKind, Observer};
use std::f64::consts::FRAC_PI_2;

impl ContactSolver<'_> {
    /// Follows sustained contact from `motion` to its exit, where `motion` is left. The adapter is
    /// shown every mode and every step.
    pub(crate) fn follow<O: Observer>(
        &mut self,
        motion: &mut Motion<f64>,
        spin: &mut Spin<f64>,
        adapter: &mut ObserverAdapter<'_, O>,
    ) -> Exit {
        let mut phase = self.enter(motion, spin);
        adapter.event(event_of(phase.mode), motion, spin);
        loop {
            if let Some(exit) = self.exit_now(motion, spin) {
                return exit;
            }
            let before = O::ACTIVE.then(|| phase.step_start());
            let (next, length) = match self.immediate_transition(&mut phase) {
                Some(next) => (next, 0.0),
                None => self.take_step(&mut phase),
            };
            let ceiling = phase.ceiling;
            self.move_to_phase(&mut phase, length, motion, spin);
            if let Some(start) = before {
                adapter.step(length, |t| self.within_step(&start, t, ceiling));
                if adapter.observer.has_seen_enough() {
                    return Exit::GivenUp;
                }
            }
            if let Some(exit) = self.apply(next, &mut phase, motion, spin) {
                return exit;
            }
            if matches!(next, PhaseTransition::ChangeMode) {
                adapter.event(event_of(phase.mode), motion, spin);
            }
        }
    }

    /// One step of the phase, tried with shorter lengths until it is accepted, and its duration.
    pub(super) fn take_step(&mut self, phase: &mut Phase) -> (PhaseTransition, f64) {
        let (dynamics, rates) = (self.rules.dynamics, &phase.now.state);
        let mut length = step_limit(dynamics, phase.mode, &phase.state, rates, phase.length);
        let mut retry = false;
        loop {
            self.usage.steps += 1;
            let number = f64::from(self.usage.steps);
            if !self.rules.limits.allow_step(length, number) {
                return (PhaseTransition::Leave(Exit::GivenUp), 0.0);
            }
            let (trial, now) = self.try_step(phase, length);
            if is_accepted(trial.error) {
                let wanted = wanted_length(length, trial.error, retry);
                return self.accept(phase, &trial, &now, length, wanted);
            }
            retry = true;
            length = shorter(length, trial.error);
        }
    }

    /// The motion a time `t` into a step, found by a shorter step from the same start.
    pub(super) fn within_step(
        &self,
        start: &StepStart,
        t: f64,
        ceiling: f64,
    ) -> (Motion<f64>, Spin<f64>) {
        let dynamics = self.rules.dynamics;
        let mut state = step(
            &start.state,
            &start.rates,
            t,
            self.rules.tolerance,
            |state: &_| dynamics.rates(state, start.mode).state,
        )
        .state;
        // a long step may pass the side slightly and return
        state[TILT] = state[TILT].clamp(0.0, self.rules.side.max(FRAC_PI_2));
        let (mut motion, mut spin) = (Motion::still(), Spin::still());
        place_below(dynamics, &mut state, &mut motion, &mut spin, ceiling);
        (motion, spin)
    }
}

pub(super) fn event_of(mode: Mode) -> EventKind {
    match mode {
        Mode::Stick => EventKind::Sticking,
        Mode::Slip => EventKind::Sliding,
    }
}

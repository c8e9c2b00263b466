//! The scalar path through contact on a tilted table.
//!
//! As on a level one, but that the pull is known to the dynamics of each step (see `crate::pull`), and
//! that the way down gives energy.

use super::dynamics::Dynamics;
use super::follow::event_of;
use super::integrator::{next_length, step};
use super::line::{LineState, line_motion, line_rates, line_state, place_on_side};
use super::on_side::{FIRST_STEP, SideExit};
use super::phase::{Exit, Phase, PhaseTransition};
use super::rim::Mode;
use super::rolling_stop::RollingStop;
use super::rules::ContactRules;
use super::solver::ContactSolver;
use super::step::can_stick;
use crate::motion::{Motion, Spin};
use crate::observer_adapter::ObserverAdapter;
use crate::pull::{Pull, longest_step};
use coinmc_core::{EventKind, Observer};

impl ContactSolver<'_> {
    /// The same solver with other dynamics.
    pub(super) fn with<'b>(&'b self, dynamics: &'b Dynamics) -> ContactSolver<'b> {
        ContactSolver {
            rules: ContactRules {
                dynamics,
                ..self.rules
            },
            usage: self.usage,
        }
    }

    /// [`follow`](Self::follow) on a tilted table.
    pub(crate) fn follow_pulled<O: Observer>(
        &mut self,
        pull: &Pull,
        motion: &mut Motion<f64>,
        spin: &mut Spin<f64>,
        adapter: &mut ObserverAdapter<'_, O>,
    ) -> Exit {
        let level = *self.rules.dynamics;
        let dynamics = level.pulled_by(pull.in_frame(adapter.place, 0.0));
        let mut phase = self.with(&dynamics).enter(motion, spin);
        adapter.event(event_of(phase.mode), motion, spin);
        loop {
            let turning = -spin.turn / motion.sin;
            phase.length = phase.length.min(longest_step(turning));
            let ahead = 0.5 * turning * phase.length;
            let dynamics = level.pulled_by(pull.in_frame(adapter.place, ahead));
            phase.now = dynamics.rates(&phase.state, phase.mode);
            let mut solver = self.with(&dynamics);
            if let Some(exit) = solver.exit_now(motion, spin) {
                return exit;
            }
            if self
                .rules
                .rule
                .lies_flat(motion.sin, [motion.vz, spin.tilt, spin.turn])
            {
                return Exit::Level;
            }
            let start = phase.step_start();
            let (next, length) = solver.next_step(&mut phase);
            let before = *adapter.place;
            adapter.step(length, |t| solver.within_step(&start, t, f64::INFINITY));
            phase.ceiling += pull.work(&before, adapter.place);
            solver.move_to_phase(&mut phase, length, motion, spin);
            self.usage = solver.usage;
            if adapter.observer.has_seen_enough() {
                return Exit::GivenUp;
            }
            if let Some(exit) = self.with(&dynamics).apply(next, &mut phase, motion, spin) {
                return exit;
            }
            if matches!(next, PhaseTransition::ChangeMode) {
                adapter.event(event_of(phase.mode), motion, spin);
            }
        }
    }

    /// The next step of a phase, or a transition that takes no time.
    fn next_step(&mut self, phase: &mut Phase) -> (PhaseTransition, f64) {
        if let Some(next) = self.immediate_transition(phase) {
            return (next, 0.0);
        }
        // the pull has turned since the last step
        if phase.mode == Mode::Stick && !can_stick(self.rules.dynamics, &phase.now) {
            return (PhaseTransition::ChangeMode, 0.0);
        }
        self.take_step(phase)
    }

    /// [`follow_on_side`](Self::follow_on_side) on a tilted table.
    pub(crate) fn follow_on_side_pulled<O: Observer>(
        &mut self,
        pull: &Pull,
        motion: &mut Motion<f64>,
        spin: &mut Spin<f64>,
        adapter: &mut ObserverAdapter<'_, O>,
    ) -> SideExit {
        let (level, creep) = (*self.rules.dynamics, self.rules.stick_speed);
        let mut state = line_state(motion, spin);
        let mut length = FIRST_STEP;
        place_on_side(&level, &state, motion, spin);
        if !self.rules.rolls_straight(&state) {
            adapter.event(EventKind::Sliding, motion, spin);
        }
        loop {
            place_on_side(&level, &state, motion, spin);
            let turning = state[3];
            length = length.min(longest_step(turning));
            let ahead = 0.5 * turning * length;
            let dynamics = level.pulled_by(pull.in_frame(adapter.place, ahead));
            let mut solver = self.with(&dynamics);
            let mut now = line_rates(&dynamics, &state, creep);
            let straight = solver.rules.rolls_straight(&state);
            if straight {
                now.share = held_share(&dynamics, &state);
            }
            if let Some(exit) = solver.side_exit(&state, &now, motion, spin) {
                return exit;
            }
            if straight {
                let exit = solver.roll_down(&state, motion, spin, adapter);
                self.usage = solver.usage;
                return SideExit::Leaves(exit);
            }
            if solver.rules.limits.is_late(solver.usage.time) {
                return SideExit::Leaves(Exit::TimeLimit);
            }
            let kinetic = motion.kinetic(&dynamics.body, spin);
            let Some((taken, trial)) = solver.step_on_side(&state, &now, length) else {
                self.usage = solver.usage;
                return SideExit::Leaves(Exit::GivenUp);
            };
            let (start, before) = (state, *adapter.place);
            adapter.step(taken, |t| {
                let rates = |s: &LineState| line_rates(&dynamics, s, creep).rates;
                let trial = step(&start, &now.rates, t, solver.rules.tolerance, rates);
                line_motion(&dynamics, &trial.state)
            });
            let ceiling = (kinetic + pull.work(&before, adapter.place)).max(0.0);
            state = solver.capped(trial.state, ceiling);
            self.usage = solver.usage;
            self.usage.time += taken;
            length = next_length(taken, trial.error);
            if adapter.observer.has_seen_enough() {
                return SideExit::Leaves(Exit::GivenUp);
            }
        }
    }

    /// The end of straight rolling on a tilted table: rolling friction holds the coin on its side, or
    /// it rolls down for ever. With a as on a level table, and p R²/(k_a + R²) what the pull p along
    /// the way gives, the coin slows down by a less that, uphill by a and that.
    fn roll_down<O: Observer>(
        &mut self,
        state: &LineState,
        motion: &mut Motion<f64>,
        spin: &mut Spin<f64>,
        adapter: &mut ObserverAdapter<'_, O>,
    ) -> Exit {
        let dynamics = *self.rules.dynamics;
        let radius = dynamics.body.outer_radius();
        let [_, pull] = dynamics.pull.unwrap_or_default();
        // the creep is lost, and with it some energy: friction keeps Λ (see `onto_side`)
        let lever = dynamics.body.ka / radius;
        let speed = (state[1] - lever * state[2]) / (1.0 + lever / radius);
        let straight = [0.0, speed, -speed / radius, 0.0];
        let rolling = RollingStop::new(&dynamics, speed.abs());
        place_on_side(&dynamics, &straight, motion, spin);
        adapter.event(EventKind::Sticking, motion, spin);
        let ahead = if speed < 0.0 { -pull } else { pull };
        let gained = ahead * radius * radius / (dynamics.body.ka + radius * radius);
        let Some(rolling) = rolling.pulled(gained) else {
            return Exit::NeverSettles;
        };
        self.slow_to_rest(&rolling, &straight, motion, spin, adapter)
    }
}

/// [`LineRates::share`](super::line::LineRates::share) of a coin that friction holds along its axis
/// against the pull, whether or not its creep has come so far.
fn held_share(dynamics: &Dynamics, state: &LineState) -> f64 {
    let [_, _, wa, wz] = *state;
    let body = &dynamics.body;
    let [pull, _] = dynamics.pull.unwrap_or_default();
    let gyro = body.kt * dynamics.axial_factor * wa * wz;
    (gyro + body.half - body.outer_radius() * pull) / (2.0 * body.half)
}

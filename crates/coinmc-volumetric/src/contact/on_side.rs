//! The path of a coin on its side, until its face is decided or it tips onto one rim.
//!
//! The face is decided by energy, or (under the tilting decision) once the weight holds both rims
//! down for good. Once only straight rolling and a creep are left, their end follows in closed
//! form.

use super::dynamics::Dynamics;
use super::integrator::{Trial, is_accepted, next_length, shorter, step};
use super::line::{
    LineFlow, LineRates, LineState, line_motion, line_rates, line_state, place_on_side,
};
use super::phase::Exit;
use super::rolling_stop::RollingStop;
use super::solver::ContactSolver;
use crate::motion::{Motion, Spin};
use crate::observer_adapter::ObserverAdapter;
use coinmc_core::{Decided, EventKind, Observer};
use std::f64::consts::FRAC_PI_2;

/// Length of the first step.
pub(super) const FIRST_STEP: f64 = 0.01;

/// How contact on the side ends.
pub(crate) enum SideExit {
    /// The coin tips onto the rim that is the lowest in its folded frame, or onto the other one.
    TipsOntoThisRim,
    TipsOntoOtherRim,
    Leaves(Exit),
}

impl ContactSolver<'_> {
    /// Follows a coin that is laid on its side. Straight rolling is shown as sticking.
    pub(crate) fn follow_on_side<O: Observer>(
        &mut self,
        motion: &mut Motion<f64>,
        spin: &mut Spin<f64>,
        adapter: &mut ObserverAdapter<'_, O>,
    ) -> SideExit {
        let (dynamics, creep) = (self.rules.dynamics, self.rules.stick_speed);
        let mut state = line_state(motion, spin);
        let mut length = FIRST_STEP;
        place_on_side(dynamics, &state, motion, spin);
        if O::ACTIVE && !self.rules.rolls_straight(&state) {
            adapter.event(EventKind::Sliding, motion, spin);
        }
        loop {
            place_on_side(dynamics, &state, motion, spin);
            let now = line_rates(dynamics, &state, creep);
            if let Some(exit) = self.side_exit(&state, &now, motion, spin) {
                return exit;
            }
            if self.rules.rolls_straight(&state) {
                return SideExit::Leaves(self.roll_to_rest(&state, motion, spin, adapter));
            }
            if self.rules.limits.is_late(self.usage.time) {
                return SideExit::Leaves(Exit::TimeLimit);
            }
            let ceiling = motion.kinetic(&dynamics.body, spin);
            let Some((taken, trial)) = self.step_on_side(&state, &now, length) else {
                return SideExit::Leaves(Exit::GivenUp);
            };
            let start = state;
            state = self.capped(trial.state, ceiling);
            self.usage.time += taken;
            adapter.step(taken, |t| {
                let rates = |s: &LineState| line_rates(dynamics, s, creep).rates;
                let trial = step(&start, &now.rates, t, self.rules.tolerance, rates);
                line_motion(dynamics, &self.capped(trial.state, ceiling))
            });
            length = next_length(taken, trial.error);
        }
    }

    /// The exit of a coin on its side that is decided or tips.
    #[inline(always)]
    pub(super) fn side_exit(
        &self,
        state: &LineState,
        now: &LineRates,
        motion: &Motion<f64>,
        spin: &Spin<f64>,
    ) -> Option<SideExit> {
        let decided = self.rules.decide(motion, spin);
        if decided != Decided::Open {
            return Some(SideExit::Leaves(Exit::Decided(decided)));
        }
        // a NaN tips neither way, and is found by the integrator
        if now.share >= 1.0 && self.tips(state, 1.0) {
            return Some(SideExit::TipsOntoThisRim);
        }
        if now.share <= 0.0 && self.tips(state, -1.0) {
            return Some(SideExit::TipsOntoOtherRim);
        }
        let rule = self.rules.rule;
        let held = rule.is_tilting() && !rule.awaits_rest() && self.is_held_down(state);
        held.then_some(SideExit::Leaves(Exit::Decided(Decided::Side)))
    }

    /// An accepted step of at most this length, and its duration; `None` if the limits allow none.
    #[inline(always)]
    pub(super) fn step_on_side(
        &mut self,
        state: &LineState,
        now: &LineRates,
        mut length: f64,
    ) -> Option<(f64, Trial<f64, 4>)> {
        let dynamics = self.rules.dynamics;
        loop {
            self.usage.steps += 1;
            let number = f64::from(self.usage.steps);
            if !self.rules.limits.allow_step(length, number) {
                return None;
            }
            // what the compiler knows to be absent takes no operations
            let trial = if dynamics.is_ordinary() && !dynamics.drag.acts() {
                self.try_on_side(&dynamics.with_known::<false, false>(), state, now, length)
            } else {
                self.try_on_side(dynamics, state, now, length)
            };
            if is_accepted(trial.error) {
                return Some((length, trial));
            }
            length = shorter(length, trial.error);
        }
    }

    /// Tries a step of this length.
    #[inline(always)]
    fn try_on_side(
        &self,
        dynamics: &Dynamics,
        state: &LineState,
        now: &LineRates,
        length: f64,
    ) -> Trial<f64, 4> {
        let flow = LineFlow {
            dynamics,
            creep: self.rules.stick_speed,
        };
        step(state, &now.rates, length, self.rules.tolerance, flow)
    }

    /// Whether contact of one rim alone agrees that the coin tips onto it: onto the lowest rim of
    /// the folded frame for `side` = 1, onto the other one for −1. (Friction that makes a rim stick
    /// may differ from the friction of its creep.)
    fn tips(&self, state: &LineState, side: f64) -> bool {
        let [vx, vy, wa, wz] = *state;
        let body = &self.rules.dynamics.body;
        let slip = side * (vy + body.outer_radius() * wa) - body.half * wz;
        let rim = [FRAC_PI_2, 0.0, side * wa, -wz, side * vx, slip];
        if side < 0.0 && self.rules.dynamics.pull.is_some() {
            return self
                .with(&self.rules.dynamics.reversed())
                .tilts_from_side(rim);
        }
        self.tilts_from_side(rim)
    }

    /// Whether the weight holds both rims down with twice the moment that friction and gyroscopic
    /// torque can raise: μR + k_t|Ω_a ω_z| <= h/2, with ω_a as it is or as it would be in rolling.
    /// Friction then only slows the coin down.
    fn is_held_down(&self, state: &LineState) -> bool {
        let [vx, vy, wa, wz] = *state;
        let dynamics = self.rules.dynamics;
        let body = &dynamics.body;
        let fastest = wa.abs().max((vx.abs() + vy.abs()) / body.outer_radius());
        let gyroscopic = body.kt * dynamics.axial_factor * fastest * wz.abs();
        2.0 * (dynamics.friction.mu * body.outer_radius() + gyroscopic) <= body.half
    }

    /// The state with no more kinetic energy than `ceiling`.
    pub(super) fn capped(&self, state: LineState, ceiling: f64) -> LineState {
        let dynamics = self.rules.dynamics;
        let (motion, spin) = line_motion(dynamics, &state);
        let kinetic = motion.kinetic(&dynamics.body, &spin);
        if kinetic > ceiling {
            let scale = (ceiling / kinetic).sqrt();
            state.map(|x| x * scale)
        } else {
            state
        }
    }

    /// The end of straight rolling, in closed form. The creep decays together with it.
    fn roll_to_rest<O: Observer>(
        &mut self,
        state: &LineState,
        motion: &mut Motion<f64>,
        spin: &mut Spin<f64>,
        adapter: &mut ObserverAdapter<'_, O>,
    ) -> Exit {
        let dynamics = self.rules.dynamics;
        let rolling = RollingStop::new(dynamics, state[1].abs());
        adapter.event(EventKind::Sticking, motion, spin);
        if !rolling.stops() {
            // drag alone never quite stops the coin; without drag it rolls forever
            return if rolling.slows() {
                if self.rules.rule.awaits_rest() {
                    // a table's edge counts where the coin will be at last
                    let way = rolling.distance().copysign(state[1]);
                    adapter.place.shift(0.0, way);
                }
                Exit::Decided(Decided::Side)
            } else {
                Exit::NeverSettles
            };
        }
        self.slow_to_rest(&rolling, state, motion, spin, adapter)
    }

    /// Shows how straight rolling that begins with `state` slows down, and leaves the coin at rest.
    pub(super) fn slow_to_rest<O: Observer>(
        &mut self,
        rolling: &RollingStop,
        state: &LineState,
        motion: &mut Motion<f64>,
        spin: &mut Spin<f64>,
        adapter: &mut ObserverAdapter<'_, O>,
    ) -> Exit {
        let dynamics = self.rules.dynamics;
        let pieces = rolling.pieces();
        let duration = rolling.time / pieces;
        let mut begun = 0.0;
        while begun < pieces {
            let start = begun * duration;
            adapter.step(duration, |t| {
                let left = rolling.left(start + t);
                line_motion(dynamics, &state.map(|rate| rate * left))
            });
            self.usage.time += duration;
            begun += 1.0;
        }
        place_on_side(dynamics, &[0.0; 4], motion, spin);
        Exit::Decided(Decided::Side)
    }
}

#[cfg(test)]
pub(crate) mod tests;

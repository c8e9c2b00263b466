//! One attempt at a step of contact, of one toss or of several side by side: how long it may be,
//! and what it finds.

use super::follow::FLAT;
use super::integrator::{Trial, is_accepted, next_length, shorter, step};
use super::rim::{Law, Mode, OMEGA_Y, Rates, RimFlow, RimState, SLIP_X, SLIP_Y, TILT};
use super::state::place_below;
use crate::motion::{Motion, Spin};
use coinmc_core::DecisionRule;
use coinmc_lanes::Lane;
use std::f64::consts::FRAC_PI_2;

/// Angle within which the other rim has come down, rad; the rest is an energy of 1e-12 at most.
pub(super) const DOWN: f64 = 1e-12;
/// A slip that brakes is followed to this fraction of itself in one step.
const BRAKE: f64 = 0.05;
/// Painlevé: K_zz − μ K_xz n_x below this (it is 1 + rx²/kt without friction) counts as 0.
pub(super) const YIELD: f64 = 1e-3;

/// A step to be attempted.
pub(crate) struct Attempt<L: Lane> {
    pub(crate) state: RimState<L>,
    pub(crate) rates: RimState<L>,
    /// Length wanted for the step; where `again`, that of the attempt.
    pub(crate) length: L,
    pub(crate) ceiling: L,
    /// An attempt at this step has failed.
    pub(crate) again: L::Mask,
}

/// What came of it.
pub(crate) struct Attempted<L: Lane> {
    /// Length of the attempt.
    pub(crate) length: L,
    /// Length wanted next: of the next step, or of the next attempt at this one.
    pub(crate) wanted: L,
    pub(crate) trial: Trial<L, 6>,
    pub(crate) now: Rates<L>,
    /// The state where the trial is a step and nothing happens in it.
    pub(crate) state: RimState<L>,
    pub(crate) accepted: L::Mask,
    /// Accepted, and something does happen.
    pub(crate) eventful: L::Mask,
    /// The face is decided after it.
    pub(crate) decided: L::Mask,
}

impl<L: Lane> Attempt<L> {
    /// Makes the attempt. `stick_speed` is the slip below which a point may be held.
    #[inline(always)]
    pub(crate) fn make(
        &self,
        law: &Law,
        rule: &DecisionRule,
        tolerance: f64,
        stick_speed: f64,
        mode: Mode,
    ) -> Attempted<L> {
        let limited = limit(law, mode, &self.state, &self.rates, self.length);
        let length = L::select(self.again, self.length, limited);
        let mut now = Rates::none();
        let flow = RimFlow {
            law,
            mode,
            last: &mut now,
        };
        let trial = step(&self.state, &self.rates, length, tolerance, flow);
        let accepted = is_accepted(trial.error);
        let calm = wanted(length, trial.error, self.again);
        let mut state = trial.state;
        let (mut motion, mut spin) = (Motion::still(), Spin::still());
        place_below(law, &mut state, &mut motion, &mut spin, self.ceiling);
        Attempted {
            length,
            wanted: L::select(accepted, calm, shorter(length, trial.error)),
            eventful: accepted & self.happens(law, stick_speed, mode, length, &trial.state, &now),
            trial,
            now,
            state,
            accepted,
            decided: rule.is_decided(&motion.decision_state(&law.body, &spin)),
        }
    }

    /// Whether a step to `state` passes an event, or may change the mode.
    #[inline(always)]
    fn happens(
        &self,
        law: &Law,
        stick_speed: f64,
        mode: Mode,
        length: L,
        state: &RimState<L>,
        now: &Rates<L>,
    ) -> L::Mask {
        let (zero, flat) = (L::splat(0.0), L::splat(FLAT));
        let tilt = state[TILT];
        let down = L::splat(FRAC_PI_2 - DOWN).lt(tilt) & zero.lt(state[OMEGA_Y]);
        let beyond = L::splat(FRAC_PI_2 + DOWN).lt(tilt);
        // on the way to level, and level already: where no step may lead on
        let level = tilt.le(flat);
        let (before, after) = (self.state[OMEGA_Y], state[OMEGA_Y]);
        let over = swings_over(self.state[TILT], before, after, length);
        let mut happens = down | beyond | over | level | !holds(law, mode, now);
        if law.conserves(mode) {
            happens = happens | (state[OMEGA_Y] * self.state[OMEGA_Y]).lt(zero);
        }
        if mode == Mode::Slip && law.friction.mu > 0.0 {
            let slows = state[SLIP_X] * now.state[SLIP_X] + state[SLIP_Y] * now.state[SLIP_Y];
            happens = happens | (slip_speed(state).le(L::splat(stick_speed)) & slows.lt(zero));
        }
        happens
    }
}

/// Whether a coin that rises at `before` and falls at `after` a step of `length` may have been on
/// its side between. The rate falls on the way; twice what it leads to at first leaves room for one
/// that rises before.
#[inline(always)]
pub(super) fn swings_over<L: Lane>(tilt: L, before: L, after: L, length: L) -> L::Mask {
    let zero = L::splat(0.0);
    let reach = tilt + L::splat(2.0) * before * length;
    zero.lt(before) & after.lt(zero) & L::splat(FRAC_PI_2).lt(reach)
}

/// The length of a step of which `length` is wanted.
#[inline(always)]
pub(super) fn limit<L: Lane>(
    law: &Law,
    mode: Mode,
    state: &RimState<L>,
    rates: &RimState<L>,
    length: L,
) -> L {
    let braking = match mode {
        Mode::Slip if law.friction.mu > 0.0 => braking_limit(state, rates),
        _ => L::splat(f64::INFINITY),
    };
    length.min(braking).min(flattening_limit(state))
}

/// A braking slip is not stepped across: its direction would flip within the step.
#[inline(always)]
fn braking_limit<L: Lane>(state: &RimState<L>, rates: &RimState<L>) -> L {
    let [.., gx, gy] = *state;
    let braking = -(gx * rates[SLIP_X] + gy * rates[SLIP_Y]);
    let most = L::splat(1.0 - BRAKE) * (gx * gx + gy * gy) / braking;
    L::select(braking.le(L::splat(0.0)), L::splat(f64::INFINITY), most)
}

/// A falling coin is not stepped to where it would be flat: the rates grow like 1/θ there.
#[inline(always)]
fn flattening_limit<L: Lane>(state: &RimState<L>) -> L {
    let (tilt, falls) = (state[TILT], state[OMEGA_Y].lt(L::splat(0.0)));
    let most = L::splat(-0.5) * tilt.max(L::splat(2.0 * FLAT)) / state[OMEGA_Y];
    L::select(falls, most, L::splat(f64::INFINITY))
}

/// The length of the step after one of `length`; `again`: that was not the first attempt.
#[inline(always)]
pub(super) fn wanted<L: Lane>(length: L, error: L, again: L::Mask) -> L {
    let next = next_length(length, error);
    // what made it too long is likely still ahead
    L::select(again, length.min(next), next)
}

/// Whether the mode is still consistent.
#[inline(always)]
pub(super) fn holds<L: Lane>(law: &Law, mode: Mode, now: &Rates<L>) -> L::Mask {
    let presses = !now.press.le(L::splat(0.0));
    presses
        & match mode {
            Mode::Slip => L::splat(YIELD).le(now.yields),
            Mode::Stick => can_stick(law, now),
        }
}

/// By how much the mode is consistent: a continuous measure, negative where it is not.
pub(super) fn margin(law: &Law, mode: Mode, now: &Rates<f64>) -> f64 {
    let consistent = match mode {
        Mode::Slip => now.yields - YIELD,
        Mode::Stick => {
            let [fx, fy] = now.friction;
            law.friction.mu * now.normal - (fx * fx + fy * fy).sqrt()
        }
    };
    now.press.min(consistent)
}

/// Whether the forces of a held contact point are within the friction cone.
#[inline(always)]
pub(super) fn can_stick<L: Lane>(law: &Law, held: &Rates<L>) -> L::Mask {
    let [fx, fy] = held.friction;
    let most = L::splat(law.friction.mu) * held.normal;
    L::splat(0.0).lt(held.normal) & (fx * fx + fy * fy).lt(most * most)
}

#[inline(always)]
pub(super) fn slip_speed<L: Lane>(state: &RimState<L>) -> L {
    let [.., gx, gy] = *state;
    (gx * gx + gy * gy).sqrt()
}

//! One try of a contact step, for one toss or several at once: how long it may be, and what lies
//! within it.

use super::dynamics::Dynamics;
use super::integrator::{Trial, is_accepted, next_length, shorter, step};
use super::rim::{Mode, OMEGA_Y, Rates, RimFlow, RimState, SLIP_X, SLIP_Y, TILT};
use super::rules::ContactRules;
use super::state::place_below;
use crate::motion::{FLAT, Motion, Spin};
use coinmc_lanes::Lane;

/// The other rim counts as touching within this angle, rad; the difference is an energy of 1e-12 at
/// most.
pub(super) const SIDE_ANGLE: f64 = 1e-12;
/// In one step a slip is slowed down to this fraction of itself at most.
const MOST_BRAKING: f64 = 0.05;
/// Painlevé: K_zz − μ K_xz n_x below this counts as 0. (Without friction it is 1 + rx²/kt.)
pub(crate) const LEAST_JAM_MARGIN: f64 = 1e-3;

/// A step to try.
pub(crate) struct StepTrial<L: Lane> {
    pub(crate) state: RimState<L>,
    pub(crate) rates: RimState<L>,
    /// Length wanted for the step; where `retry`, the length of the try.
    pub(crate) length: L,
    pub(crate) ceiling: L,
    /// A try of this step has failed.
    pub(crate) retry: L::Mask,
}

/// What a try found.
pub(crate) struct Tried<L: Lane> {
    /// Length of the try.
    pub(crate) length: L,
    /// Length wanted next: for the next step, or for the next try of this one.
    pub(crate) wanted: L,
    pub(crate) trial: Trial<L, 6>,
    pub(crate) now: Rates<L>,
    /// The state at the end of the step, valid if the step is accepted and has no event.
    pub(crate) state: RimState<L>,
    pub(crate) accepted: L::Mask,
    /// The step is accepted, and an event lies within it.
    pub(crate) eventful: L::Mask,
    /// The face is decided after the step.
    pub(crate) decided: L::Mask,
}

impl<L: Lane> StepTrial<L> {
    /// Tries the step. `dynamics` are those of `rules`, with drag known to the compiler.
    #[inline(always)]
    pub(crate) fn run(
        &self,
        dynamics: &Dynamics,
        rules: &ContactRules<'_>,
        mode: Mode,
    ) -> Tried<L> {
        let limited = step_limit(dynamics, mode, &self.state, &self.rates, self.length);
        let length = L::select(self.retry, self.length, limited);
        let mut now = Rates::none();
        let flow = RimFlow {
            dynamics,
            mode,
            last: &mut now,
        };
        let trial = step(&self.state, &self.rates, length, rules.tolerance, flow);
        let accepted = is_accepted(trial.error);
        let after_accepted = wanted_length(length, trial.error, self.retry);
        let wanted = L::select(accepted, after_accepted, shorter(length, trial.error));
        let mut state = trial.state;
        let (mut motion, mut spin) = (Motion::still(), Spin::still());
        place_below(dynamics, &mut state, &mut motion, &mut spin, self.ceiling);
        let eventful = self.has_event(dynamics, rules, mode, length, &trial.state, &now);
        Tried {
            length,
            wanted,
            eventful: accepted & eventful,
            trial,
            now,
            state,
            accepted,
            decided: rules
                .rule
                .is_decided(&motion.decision_state(&dynamics.body, &spin)),
        }
    }

    /// Whether a step to `state` passes an event, or may change the mode.
    #[inline(always)]
    fn has_event(
        &self,
        dynamics: &Dynamics,
        rules: &ContactRules<'_>,
        mode: Mode,
        length: L,
        state: &RimState<L>,
        now: &Rates<L>,
    ) -> L::Mask {
        let (zero, flat) = (L::splat(0.0), L::splat(FLAT));
        let tilt = state[TILT];
        let on_side = L::splat(rules.side - SIDE_ANGLE).lt(tilt) & zero.lt(state[OMEGA_Y]);
        let beyond = L::splat(rules.side + SIDE_ANGLE).lt(tilt);
        // about to become level, or level already: no step may start from here
        let level = tilt.le(flat);
        let (before, after) = (self.state[OMEGA_Y], state[OMEGA_Y]);
        let over = may_reach_side(self.state[TILT], before, after, length, rules.side);
        let mut happens = on_side | beyond | over | level | !holds(dynamics, mode, now);
        if dynamics.conserves(mode) {
            happens = happens | (state[OMEGA_Y] * self.state[OMEGA_Y]).lt(zero);
        }
        if mode == Mode::Slip && dynamics.friction.mu > 0.0 {
            let slows = state[SLIP_X] * now.state[SLIP_X] + state[SLIP_Y] * now.state[SLIP_Y];
            happens =
                happens | (slip_speed(state).le(L::splat(rules.stick_speed)) & slows.lt(zero));
        }
        happens
    }
}

/// Whether the tilt, which grows at the rate `before` at the start of a step and falls at its end,
/// may have reached the side in between. The rate decreases on the way; the factor of 2 leaves room
/// for a rate that increases first.
#[inline(always)]
pub(super) fn may_reach_side<L: Lane>(
    tilt: L,
    before: L,
    after: L,
    length: L,
    side: f64,
) -> L::Mask {
    let zero = L::splat(0.0);
    let reach = tilt + L::splat(2.0) * before * length;
    zero.lt(before) & after.lt(zero) & L::splat(side).lt(reach)
}

/// The length of a step, given the wanted length: limited by what the state allows.
#[inline(always)]
pub(crate) fn step_limit<L: Lane>(
    dynamics: &Dynamics,
    mode: Mode,
    state: &RimState<L>,
    rates: &RimState<L>,
    wanted: L,
) -> L {
    let braking = match mode {
        Mode::Slip if dynamics.friction.mu > 0.0 => braking_limit(state, rates),
        _ => L::splat(f64::INFINITY),
    };
    wanted.min(braking).min(flattening_limit(state))
}

/// No step passes the end of a slip: its direction would reverse within the step.
#[inline(always)]
fn braking_limit<L: Lane>(state: &RimState<L>, rates: &RimState<L>) -> L {
    let [.., gx, gy] = *state;
    let braking = -(gx * rates[SLIP_X] + gy * rates[SLIP_Y]);
    let most = L::splat(1.0 - MOST_BRAKING) * (gx * gx + gy * gy) / braking;
    L::select(braking.le(L::splat(0.0)), L::splat(f64::INFINITY), most)
}

/// No step of a falling coin reaches the tilt where it would be level: the rates grow like 1/θ
/// there.
#[inline(always)]
fn flattening_limit<L: Lane>(state: &RimState<L>) -> L {
    let (tilt, falls) = (state[TILT], state[OMEGA_Y].lt(L::splat(0.0)));
    let most = L::splat(-0.5) * tilt.max(L::splat(2.0 * FLAT)) / state[OMEGA_Y];
    L::select(falls, most, L::splat(f64::INFINITY))
}

/// The length wanted after an accepted step of this length; `retry` if it was not its first try.
#[inline(always)]
pub(super) fn wanted_length<L: Lane>(length: L, error: L, retry: L::Mask) -> L {
    let next = next_length(length, error);
    // what made the first try fail is likely still ahead
    L::select(retry, length.min(next), next)
}

/// Whether the mode is consistent with its forces.
#[inline(always)]
pub(crate) fn holds<L: Lane>(dynamics: &Dynamics, mode: Mode, now: &Rates<L>) -> L::Mask {
    let presses = !now.press.le(L::splat(0.0));
    presses
        & match mode {
            Mode::Slip => L::splat(LEAST_JAM_MARGIN).le(now.jam_margin),
            Mode::Stick => can_stick(dynamics, now),
        }
}

/// By how much the mode is consistent: a continuous measure, negative where it is not.
pub(super) fn margin(dynamics: &Dynamics, mode: Mode, now: &Rates<f64>) -> f64 {
    let consistent = match mode {
        Mode::Slip => now.jam_margin - LEAST_JAM_MARGIN,
        Mode::Stick => {
            let [fx, fy] = now.friction;
            dynamics.friction.mu * now.normal - (fx * fx + fy * fy).sqrt()
        }
    };
    now.press.min(consistent)
}

/// Whether the forces that hold a sticking contact point lie in the friction cone.
#[inline(always)]
pub(crate) fn can_stick<L: Lane>(dynamics: &Dynamics, sticking: &Rates<L>) -> L::Mask {
    let [fx, fy] = sticking.friction;
    let most = L::splat(dynamics.friction.mu) * sticking.normal;
    L::splat(0.0).lt(sticking.normal) & (fx * fx + fy * fy).lt(most * most)
}

#[inline(always)]
pub(crate) fn slip_speed<L: Lane>(state: &RimState<L>) -> L {
    let [.., gx, gy] = *state;
    (gx * gx + gy * gy).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::Friction;
    use crate::contact::phase::Phase;
    use crate::contact::tests::{STILL, dynamics};
    use crate::contact::tilt_search::TiltSearch;
    use crate::settings::Settings;
    use crate::toss::tests::{generic_scene, model_of};
    use coinmc_testkit::Dice;

    /// Wherever a step is searched for a rim that touches, at the side or level, its end has an event; and there is none
    /// just before.
    #[test]
    fn a_step_to_where_a_rim_touches_has_an_event() {
        let model = model_of(&generic_scene(|plane| plane), &Settings::default());
        let (dynamics, rules) = (&model.dynamics, model.contact_rules());
        let event = |from: f64, tilt: f64, rate: f64| {
            let state = [from, rate, 0.0, 0.0, 0.0, 0.0];
            let rates = dynamics.rates(&state, Mode::Stick);
            let trial = StepTrial {
                state,
                rates: rates.state,
                length: 0.01,
                ceiling: 1.0,
                retry: false,
            };
            let mut phase = Phase::none();
            phase.state = state;
            let mut end = state;
            end[TILT] = tilt;
            // a contact that presses and sticks
            let now = Rates {
                normal: 1.0,
                press: 1.0,
                ..Rates::none()
            };
            let happens = trial.has_event(dynamics, &rules, Mode::Stick, 0.01, &end, &now);
            let found = TiltSearch::within(&phase, &end, 0.01, rules.side);
            (happens, found.is_some())
        };
        let side = rules.side;
        for (tilt, rate, touches) in [
            (side - 2.0 * SIDE_ANGLE, 0.2, false),
            (side - 0.5 * SIDE_ANGLE, 0.2, true),
            (side - 0.5 * SIDE_ANGLE, -0.2, false),
            (side + 0.5 * SIDE_ANGLE, 0.2, true),
            (side + 2.0 * SIDE_ANGLE, 0.2, true),
            (side + 2.0 * SIDE_ANGLE, -0.2, true),
            (1.1 * FLAT, -0.2, false),
            (0.9 * FLAT, -0.2, true),
        ] {
            let from = if tilt > 1.0 { side - 1e-3 } else { 1e-3 };
            assert_eq!(event(from, tilt, rate), (touches, touches), "{tilt} {rate}");
        }
    }

    /// Only friction ends a slip.
    #[test]
    fn friction_limits_the_steps_of_a_slip() {
        let state = [1.0, 0.5, 0.0, 0.0, 0.3, 0.4];
        let mut rates = [0.0; 6];
        (rates[SLIP_X], rates[SLIP_Y]) = (-1.2, -1.6);
        // .5 at 2
        let stops = 0.25;
        for (mu, mode, limited) in [
            (0.3, Mode::Slip, true),
            (0.3, Mode::Stick, false),
            (0.0, Mode::Slip, false),
        ] {
            let friction = Friction {
                mu,
                contour: 0.0,
                pivoting: 0.0,
            };
            let dynamics = dynamics(0.4, friction, STILL, false);
            let length = step_limit(&dynamics, mode, &state, &rates, 1.0);
            assert_eq!(length < stops, limited);
            assert!(limited || length == 1.0);
            assert_eq!(step_limit(&dynamics, mode, &state, &rates, 0.1), 0.1);
        }
    }

    /// The margin is positive exactly where the mode holds: the coin presses, and slip does not jam, or friction
    /// within μN suffices to stick; and it is the smaller of the two excesses.
    #[test]
    fn the_margin_is_positive_where_the_mode_holds() {
        let friction = Friction {
            mu: 0.3,
            contour: 0.01,
            pivoting: 0.001,
        };
        let dynamics = dynamics(0.4, friction, STILL, false);
        let mut held = [0; 2];
        for number in 0..1000 {
            let mut dice = Dice::new(818, number);
            let now = Rates {
                state: [0.0; 6],
                normal: dice.between(0.1, 1.0),
                friction: [dice.between(-0.3, 0.3), dice.between(-0.3, 0.3)],
                press: dice.between(-0.5, 1.0),
                jam_margin: dice.between(-0.5, 1.0),
            };
            let size = libm::hypot(now.friction[0], now.friction[1]);
            let excess = [now.jam_margin - LEAST_JAM_MARGIN, 0.3 * now.normal - size];
            for (i, mode) in [Mode::Slip, Mode::Stick].into_iter().enumerate() {
                let found = margin(&dynamics, mode, &now);
                assert!((found - excess[i].min(now.press)).abs() < 1e-15);
                assert_eq!(found > 0.0, holds(&dynamics, mode, &now), "{now:?}");
                held[i] += usize::from(found > 0.0);
            }
        }
        assert!(held.iter().all(|count| *count > 100), "{held:?}");
    }

    /// A slip that friction brakes keeps a share of its speed; one that it drives has no limit.
    #[test]
    fn a_step_ends_before_the_slip_does_and_before_the_coin_is_level() {
        let mut state = [0.1, -0.5, 0.0, 0.0, 0.3, 0.4];
        let mut rates = [0.0; 6];
        (rates[SLIP_X], rates[SLIP_Y]) = (-1.2, -1.6);
        let time = braking_limit(&state, &rates);
        let left = 0.5 - 2.0 * time;
        assert!((left - MOST_BRAKING * 0.5).abs() < 1e-15, "{left}");
        rates[SLIP_X] = 3.0;
        assert!(braking_limit(&state, &rates).is_infinite());
        assert!((flattening_limit(&state) - 0.1).abs() < 1e-15);
        state[TILT] = 0.0;
        assert!((flattening_limit(&state) - 2.0 * FLAT).abs() < 1e-15);
        state[OMEGA_Y] = 0.5;
        assert!(flattening_limit(&state).is_infinite());
        assert!((wanted_length(0.7, 1e-30, false) - 3.5).abs() < 1e-15);
        assert!((wanted_length(0.7, 1e-30, true) - 0.7).abs() < 1e-15);
        assert!((wanted_length(0.7, 1e30, true) - 0.14).abs() < 1e-15);
    }
}

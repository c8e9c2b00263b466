//! The state machine of contact on one rim point: entering, leaving and changing phases.

use super::integrator::Trial;
use super::phase::{Exit, Phase, PhaseTransition};
use super::rim::{Mode, OMEGA_Y, Rates, RimState, TILT};
use super::rules::{ContactRules, Usage};
use super::scalar_step::ScalarStep;
use super::state::{after_impulse, change_slip, place_below, rim_state};
use super::step::{LEAST_JAM_MARGIN, can_stick, slip_speed};
use crate::impact::jam_impulse;
use crate::motion::{FLAT, Motion, Spin};
use coinmc_core::Decided;

/// A contact point that starts to slip does so at this fraction of `stick_speed`; the direction of
/// slip then settles within a time of that order.
pub(super) const INITIAL_SLIP: f64 = 1.0;
/// A slip that slows down to this fraction of the initial slip starts anew.
pub(crate) const RESTART_SLIP: f64 = 0.1;

/// The contact of one toss.
pub(crate) struct ContactSolver<'a> {
    pub(crate) rules: ContactRules<'a>,
    pub(crate) usage: Usage,
}

impl ContactSolver<'_> {
    /// From `motion` to its first phase.
    pub(crate) fn enter(&self, motion: &mut Motion<f64>, spin: &mut Spin<f64>) -> Phase {
        let mut phase = self.choose_phase(rim_state(self.rules.dynamics, motion, spin));
        let rate = (1.0 + spin.tilt * spin.tilt + spin.axial * spin.axial).sqrt();
        phase.length = 0.1 / rate;
        self.move_to_start(&mut phase, motion, spin);
        phase
    }

    /// From a phase to where its next step starts, through all transitions that take no time;
    /// `Some` if contact ends before.
    pub(crate) fn exit_before_step(
        &mut self,
        phase: &mut Phase,
        motion: &mut Motion<f64>,
        spin: &mut Spin<f64>,
    ) -> Option<Exit> {
        loop {
            if let Some(exit) = self.exit_now(motion, spin) {
                return Some(exit);
            }
            let next = self.immediate_transition(phase)?;
            self.move_to_phase(phase, 0.0, motion, spin);
            if let Some(exit) = self.apply(next, phase, motion, spin) {
                return Some(exit);
            }
        }
    }

    /// The exit of a phase whose face is decided or whose toss has reached a limit.
    pub(super) fn exit_now(&self, motion: &Motion<f64>, spin: &Spin<f64>) -> Option<Exit> {
        let decided = self.rules.decide(motion, spin);
        if decided != Decided::Open {
            Some(Exit::Decided(decided))
        } else if self.rules.limits.no_step_left(self.usage.steps) {
            Some(Exit::GivenUp)
        } else if self.rules.limits.is_late(self.usage.time) {
            Some(Exit::TimeLimit)
        } else {
            None
        }
    }

    /// The transition of a phase whose state allows no step.
    pub(super) fn immediate_transition(&mut self, phase: &mut Phase) -> Option<PhaseTransition> {
        if phase.state[TILT] <= FLAT && phase.state[OMEGA_Y] < 0.0 {
            Some(PhaseTransition::Leave(Exit::Level))
        } else if phase.now.press <= 0.0 {
            Some(PhaseTransition::Leave(Exit::LiftOff))
        } else if phase.mode == Mode::Slip && phase.now.jam_margin < LEAST_JAM_MARGIN {
            Some(self.resolve_jam(phase))
        } else {
            None
        }
    }

    /// Carries out a transition; `Some` if contact ends with it.
    pub(crate) fn apply(
        &self,
        next: PhaseTransition,
        phase: &mut Phase,
        motion: &mut Motion<f64>,
        spin: &mut Spin<f64>,
    ) -> Option<Exit> {
        match next {
            PhaseTransition::Stay => None,
            PhaseTransition::ChangeMode => {
                self.change_mode(phase, motion, spin);
                None
            }
            PhaseTransition::Leave(exit) => Some(exit),
        }
    }

    /// From a phase whose mode no longer holds to the next phase.
    fn change_mode(&self, phase: &mut Phase, motion: &mut Motion<f64>, spin: &mut Spin<f64>) {
        let length = phase.length;
        *phase = self.choose_phase(phase.state);
        phase.length = length;
        self.move_to_start(phase, motion, spin);
    }

    /// A jam (Painlevé's configuration): an impulse at the contact point, without approach, ends
    /// the slip.
    pub(super) fn resolve_jam(&mut self, phase: &mut Phase) -> PhaseTransition {
        self.usage.jams += 1;
        self.usage.steps += 1;
        let dynamics = self.rules.dynamics;
        phase.state = after_impulse(dynamics, &phase.state, |point| {
            jam_impulse(&dynamics.body, &dynamics.friction, point)
        });
        PhaseTransition::ChangeMode
    }

    /// What follows a step that the limits do not allow.
    pub(crate) fn give_up(
        &mut self,
        phase: &mut Phase,
        motion: &mut Motion<f64>,
        spin: &mut Spin<f64>,
    ) -> PhaseTransition {
        self.move_to_phase(phase, 0.0, motion, spin);
        PhaseTransition::Leave(Exit::GivenUp)
    }

    /// Tries a step of this length: the state and the rates at its end.
    pub(super) fn try_step(&self, phase: &Phase, length: f64) -> (Trial<f64, 6>, Rates<f64>) {
        let step = ScalarStep {
            state: &phase.state,
            now: &phase.now,
            mode: phase.mode,
            length,
            tolerance: self.rules.tolerance,
        };
        step.run(self.rules.dynamics)
    }

    /// Moves `motion` to the state of `phase`, which a step of this length has led to.
    #[inline]
    pub(crate) fn move_to_phase(
        &mut self,
        phase: &mut Phase,
        length: f64,
        motion: &mut Motion<f64>,
        spin: &mut Spin<f64>,
    ) {
        self.usage.time += length;
        let ceiling = phase.ceiling;
        place_below(self.rules.dynamics, &mut phase.state, motion, spin, ceiling);
    }

    /// Moves `motion` to the start of a new phase, with no more energy than it has.
    fn move_to_start(&self, phase: &mut Phase, motion: &mut Motion<f64>, spin: &mut Spin<f64>) {
        let dynamics = self.rules.dynamics;
        let before = motion.energy(&dynamics.body, spin);
        place_below(dynamics, &mut phase.state, motion, spin, before);
        phase.ceiling = motion.energy(&dynamics.body, spin).min(before);
    }

    /// The phase of a state: it sticks if the slip is below `stick_speed` and friction can hold the
    /// point, otherwise it slips.
    fn choose_phase(&self, state: RimState<f64>) -> Phase {
        let dynamics = self.rules.dynamics;
        let slip = slip_speed(&state);
        if dynamics.friction.mu == 0.0 || slip > self.rules.stick_speed {
            return self.phase(state, Mode::Slip);
        }
        let sticking = self.phase(change_slip(dynamics, &state, 0.0, 0.0), Mode::Stick);
        if can_stick(dynamics, &sticking.now) {
            return sticking;
        }
        let [fx, fy] = sticking.now.friction;
        let needed = (fx * fx + fy * fy).sqrt();
        let initial = INITIAL_SLIP * self.rules.stick_speed;
        if slip < RESTART_SLIP * initial && needed > 0.0 {
            self.start_slipping(&state, [fx, fy], -initial / needed)
        } else {
            self.phase(state, Mode::Slip)
        }
    }

    /// The phase of a point that starts to slip, against the friction that would have to hold it.
    /// `scale` times this friction is the slip.
    fn start_slipping(&self, state: &RimState<f64>, [fx, fy]: [f64; 2], scale: f64) -> Phase {
        let slipping = |gx, gy| {
            let state = change_slip(self.rules.dynamics, state, gx, gy);
            self.phase(state, Mode::Slip)
        };
        let against = slipping(scale * fx, scale * fy);
        // at high friction, slip in one direction may jam while slip in the other does not
        if against.now.jam_margin < LEAST_JAM_MARGIN {
            slipping(-scale * fx, scale * fy)
        } else {
            against
        }
    }

    fn phase(&self, state: RimState<f64>, mode: Mode) -> Phase {
        Phase {
            state,
            mode,
            now: self.rules.dynamics.rates(&state, mode),
            ..Phase::none()
        }
    }

    /// Whether a coin in contact in this state presses on the surface and tilts away from its side.
    pub(crate) fn tilts_from_side(&self, state: RimState<f64>) -> bool {
        let now = self.choose_phase(state).now;
        now.press > 0.0 && now.state[OMEGA_Y] < 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::Friction;
    use crate::contact::rim::{SLIP_X, SLIP_Y};
    use crate::contact::tests::{STILL, dynamics};
    use crate::laws::Moreau;
    use crate::model::Model;
    use crate::settings::Settings;
    use crate::toss::tests::{model, model_of};
    use coinmc_core::{Coin, Scene, Surface};
    use coinmc_testkit::Dice;

    /// A contact point that friction can hold sticks. One that it cannot hold starts to slip at `stick_speed`,
    /// against the friction that would have to hold it; one that slips faster goes on as it is.
    #[test]
    fn a_point_that_friction_cannot_hold_starts_to_slip_against_it() {
        let model = model();
        let solver = model.contact_solver(Usage::default());
        let slow = solver.rules.stick_speed;
        let (mut stuck, mut started) = (0, 0);
        for trial in 0..2_000 {
            let mut dice = Dice::new(520, trial);
            let mut rate = || dice.between(-2.0, 2.0);
            let [wy, wa, wt] = [rate(), rate(), rate()];
            let still = [dice.between(0.2, 1.5), wy, wa, wt, 0.0, 0.0];
            let held = model.dynamics.rates(&still, Mode::Stick);
            let phase = solver.choose_phase(still);
            if can_stick(&model.dynamics, &held) {
                stuck += 1;
                let off = phase
                    .state
                    .iter()
                    .zip(still)
                    .map(|(now, before)| now - before);
                assert!(phase.mode == Mode::Stick && off.into_iter().all(|off| off.abs() < 1e-12));
            } else if phase.now.jam_margin >= LEAST_JAM_MARGIN {
                started += 1;
                let [gx, gy] = [phase.state[SLIP_X], phase.state[SLIP_Y]];
                let [fx, fy] = held.friction;
                assert!(phase.mode == Mode::Slip);
                assert!((slip_speed(&phase.state) - slow).abs() < 1e-12 * slow);
                let along = (gx * fx + gy * fy) / (slow * (fx * fx + fy * fy).sqrt());
                assert!((along + 1.0).abs() < 1e-9, "{along}");
            }
            let mut slips = still;
            slips[SLIP_Y] = 1.5 * slow;
            let phase = solver.choose_phase(slips);
            assert!(phase.mode == Mode::Slip && phase.state == slips);
        }
        assert!(stuck > 100 && started > 100, "{stuck} {started}");
    }

    /// A coin on a surface where slip may jam.
    fn sticky() -> Model<Moreau> {
        let coin = Coin::cylinder(0.7, 0.01).expect("a valid coin");
        let surface = Surface::new(0.5, 3.0).expect("a valid surface");
        let scene = Scene::new(coin, surface, 9.81).expect("a valid scene");
        model_of(&scene, &Settings::default())
    }

    /// Where a slip against that friction would jam, the point starts to slip the other way along x: as fast, and across
    /// as it would.
    #[test]
    fn a_point_whose_slip_would_jam_starts_to_slip_the_other_way() {
        let model = sticky();
        let dynamics = &model.dynamics;
        let solver = model.contact_solver(Usage::default());
        let slow = solver.rules.stick_speed;
        let mut jams = 0;
        for trial in 0..4_000 {
            let mut dice = Dice::new(559, trial);
            let mut rate = || dice.between(-3.0, 3.0);
            let still = [1.0 + 0.15 * rate(), rate(), rate(), rate(), 0.0, 0.0];
            let held = dynamics.rates(&still, Mode::Stick);
            if can_stick(dynamics, &held) {
                continue;
            }
            let [fx, fy] = held
                .friction
                .map(|part| part / libm::hypot(held.friction[0], held.friction[1]));
            let against = change_slip(dynamics, &still, -slow * fx, -slow * fy);
            if dynamics.rates(&against, Mode::Slip).jam_margin >= LEAST_JAM_MARGIN {
                continue;
            }
            jams += 1;
            let phase = solver.choose_phase(still);
            assert!(phase.mode == Mode::Slip && phase.now.jam_margin >= LEAST_JAM_MARGIN);
            let [gx, gy] = [phase.state[SLIP_X], phase.state[SLIP_Y]];
            assert!((gx - slow * fx).abs() < 1e-9 * slow && (gy + slow * fy).abs() < 1e-9 * slow);
        }
        assert!(jams > 50, "{jams}");
    }

    /// Contact ends at once where the coin comes down flat or where its point would leave the surface; where a slip
    /// jams, an impulse without approach changes the slip; and otherwise nothing happens before the next step.
    #[test]
    fn a_state_without_a_step_is_left_at_once() {
        let model = sticky();
        let dynamics = &model.dynamics;
        let mut solver = model.contact_solver(Usage::default());
        let mut next = |tilt: f64, wy: f64| {
            let state = [tilt, wy, 0.2, 0.0, 0.0, 0.0];
            let mut phase = solver.phase(state, Mode::Stick);
            solver.immediate_transition(&mut phase)
        };
        let leaves =
            |next, exit| matches!(next, Some(PhaseTransition::Leave(found)) if found == exit);
        assert!(leaves(next(FLAT, -0.1), Exit::Level));
        assert!(next(FLAT, 0.1).is_none() && next(2.0 * FLAT, -0.1).is_none());
        // with its centre straight above the point, at a height of 1, it presses with 1 − ω_y²
        let balance = libm::atan2(2.0, 0.7);
        for (wy, leaves_surface) in [(1.01, true), (-1.01, true), (0.99, false)] {
            let exit = next(balance, wy);
            assert_eq!(leaves(exit, Exit::LiftOff), leaves_surface, "{wy}");
            assert_eq!(exit.is_none(), !leaves_surface);
        }
        let mut jams = 0;
        for number in 0..2_000 {
            let mut dice = Dice::new(553, number);
            let mut rate = || dice.between(-0.5, 0.5);
            let state = [0.8 + rate(), rate(), rate(), rate(), rate(), rate()];
            let mut phase = solver.phase(state, Mode::Slip);
            if phase.now.jam_margin >= LEAST_JAM_MARGIN || phase.now.press <= 0.0 {
                continue;
            }
            jams += 1;
            let used = solver.usage;
            let next = solver.immediate_transition(&mut phase);
            assert!(matches!(next, Some(PhaseTransition::ChangeMode)));
            assert_eq!(
                [
                    solver.usage.jams - used.jams,
                    solver.usage.steps - used.steps
                ],
                [1, 1]
            );
            let energy = |state: &RimState<f64>| {
                let (mut motion, mut spin) = (Motion::still(), Spin::still());
                crate::contact::place(dynamics, state, &mut motion, &mut spin);
                motion.kinetic(&dynamics.body, &spin)
            };
            assert!(energy(&phase.state) < energy(&state));
            assert_eq!(phase.state[TILT], state[TILT]);
            assert!(slip_speed(&phase.state) < slip_speed(&state));
        }
        assert!(jams > 50, "{jams}");
    }

    /// On one rim alone a coin that was on its side falls back onto the other one, unless its slip along its axis
    /// makes friction push below its centre against that, with more moment than the weight: μR > h.
    #[test]
    fn a_coin_tilts_from_its_side_where_friction_has_more_moment_than_the_weight() {
        let model = model();
        let level = model.contact_solver(Usage::default());
        let mut seen = [0; 2];
        for number in 0..400 {
            let mut dice = Dice::new(554, number);
            let friction = Friction {
                mu: dice.between(0.1, 1.0),
                contour: 0.0,
                pivoting: 0.0,
            };
            let dynamics = dynamics(dice.scale(0.1, 2.0), friction, STILL, true);
            let slip = dice.between(0.05, 1.0);
            let body = &dynamics.body;
            let pushes = friction.mu * body.radius > body.half;
            let solver = level.with(&dynamics);
            let tilts = |slip: f64| {
                solver.tilts_from_side([std::f64::consts::FRAC_PI_2, 0.0, 0.0, 0.0, slip, 0.0])
            };
            assert_eq!(tilts(-slip), pushes);
            assert!(!tilts(slip) && !tilts(0.0));
            seen[usize::from(pushes)] += 1;
        }
        assert!(seen[0] > 50 && seen[1] > 50, "{seen:?}");
    }
}

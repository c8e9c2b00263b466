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
                let way = rolling.distance().copysign(state[1]);
                adapter.place.shift(0.0, way);
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
pub(crate) mod tests {
    use super::*;
    use crate::contact::Usage;
    use crate::place::Place;
    use crate::settings::{Decision, Settings};
    use crate::toss::tests::{generic_scene, model_of, stops_plainly};
    use coinmc_core::{Coin, Scene, Surface};
    use coinmc_testkit::Dice;
    use coinmc_testkit::Recorder;
    use nalgebra::Vector3;

    /// A body that rolls straight on its side at `speed`, in the direction of its sign.
    pub(crate) fn rolls(dynamics: &Dynamics, speed: f64) -> LineState {
        [0.0, speed, -speed / dynamics.body.outer_radius(), 0.0]
    }

    /// The way and the time of straight rolling, by its equation of motion: contour friction and drag slow it down,
    /// and a pull along the way does not.
    pub(crate) fn rolls_plainly(dynamics: &Dynamics, speed: f64, pull: f64) -> (f64, f64) {
        let (friction, drag) = (&dynamics.friction, &dynamics.drag);
        let radius = dynamics.body.outer_radius();
        let share = dynamics.body.ka / (radius * radius);
        let slowing = |v: f64| {
            let dragged = (drag.linear + drag.angular * share) * v;
            (friction.contour / radius + dragged - pull) / (1.0 + share)
        };
        stops_plainly(slowing, speed)
    }

    /// Straight rolling ends where its equation of motion ends it, whichever way it goes and wherever in the
    /// laboratory, and is shown until then.
    #[test]
    fn straight_rolling_ends_where_friction_and_drag_end_it() {
        let model = model_of(&generic_scene(|plane| plane), &Settings::default());
        let dynamics = &model.dynamics;
        for speed in [0.4, -0.9] {
            let mut solver = model.contact_solver(Usage {
                time: 1.5,
                ..Usage::default()
            });
            let state = rolls(dynamics, speed);
            let (mut motion, mut spin) = line_motion(dynamics, &state);
            let mut place = Place::at([0.2, -0.1], [0.6, 0.8]);
            let before = place;
            let mut adapter = ObserverAdapter {
                observer: &mut Recorder::default(),
                place: &mut place,
                heads_up: true,
                units: &model.units,
            };
            let exit = solver.roll_to_rest(&state, &mut motion, &mut spin, &mut adapter);
            assert_eq!(exit, Exit::Decided(Decided::Side));
            let (way, time) = rolls_plainly(dynamics, speed.abs(), 0.0);
            let [x, y] = before.in_frame(place.way_from(&before));
            assert!(x.abs() < 1e-12 && (y / way.copysign(speed) - 1.0).abs() < 1e-4);
            for took in [place.time, solver.usage.time - 1.5] {
                assert!((took / time - 1.0).abs() < 1e-4, "{took} {time}");
            }
            assert_eq!(motion.kinetic(&dynamics.body, &spin), 0.0);
        }
    }

    /// A thick coin that slides along its axis on its side is stopped by μ m g, and the clock goes on from where it was.
    #[test]
    fn sliding_on_the_side_takes_the_time_that_friction_takes() {
        let coin = Coin::cylinder(2.0, 0.01).expect("a valid coin");
        let surface = Surface::new(0.5, 0.1).and_then(|it| it.with_friction_lengths(1e-4, 1e-5));
        let scene = Scene::new(coin, surface.expect("a valid surface"), 9.81);
        let settings = Settings {
            decision: Decision::Energy,
            ..Settings::default()
        };
        let model = model_of(&scene.expect("a valid scene"), &settings);
        // more than what decides its face
        let speed = 2.0;
        for begun in [0.0, 3.0] {
            let mut solver = model.contact_solver(Usage {
                time: begun,
                ..Usage::default()
            });
            let state = [speed, 0.0, 0.0, 0.0];
            let (mut motion, mut spin) = line_motion(&model.dynamics, &state);
            let mut adapter = ObserverAdapter {
                observer: &mut (),
                place: &mut Place::at([0.0; 2], [1.0, 0.0]),
                heads_up: true,
                units: &model.units,
            };
            let exit = solver.follow_on_side(&mut motion, &mut spin, &mut adapter);
            assert!(matches!(
                exit,
                SideExit::Leaves(Exit::Decided(Decided::Side))
            ));
            let took = solver.usage.time - begun;
            let slower = speed - motion.vx;
            assert!(
                slower > 0.5 && (took / (slower / 0.1) - 1.0).abs() < 1e-3,
                "{took} {slower}"
            );
        }
    }

    /// Both rims stay down for sure while the moment of the weight, h/2 of it, is not exceeded by those of friction
    /// and of the turning angular momentum, ω × L. A coin that slides is taken as fast as one that rolls.
    #[test]
    fn the_weight_holds_the_rims_down_up_to_half_its_moment() {
        for number in 0..100 {
            let mut dice = Dice::new(550, number);
            let coin = Coin::cylinder(dice.between(1.0, 2.0), 0.01).expect("a valid coin");
            let surface = Surface::new(0.5, dice.between(0.05, 0.2)).expect("a valid surface");
            let scene = Scene::new(coin, surface, 9.81).expect("a valid scene");
            let model = model_of(&scene, &Settings::default());
            let (solver, dynamics) = (model.contact_solver(Usage::default()), &model.dynamics);
            let body = &dynamics.body;
            let axial = dice.between(0.5, 2.0);
            let fastest = |held: &dyn Fn(f64) -> bool| {
                let (mut slow, mut fast) = (0.0, 1e3);
                for _ in 0..80 {
                    let rate = 0.5 * (slow + fast);
                    if held(rate) {
                        slow = rate;
                    } else {
                        fast = rate;
                    }
                }
                slow
            };
            let of_friction = Vector3::new(0.0, 0.0, -body.radius)
                .cross(&(Vector3::x() * dynamics.friction.mu))
                .norm();
            let momentum = Vector3::x() * (body.ka * axial);
            let expected = (0.5 * body.half - of_friction) / Vector3::z().cross(&momentum).norm();
            let share = dice.between(-1.0, 1.0);
            let speed = axial * body.radius;
            let (along, across) = (share * speed, (1.0 - share.abs()) * speed);
            for way in [-1.0, 1.0] {
                for state in [
                    [0.0, 0.0, axial, way],
                    [0.1 * speed, -0.2 * speed, -axial, way],
                    [along, across, 0.3 * axial, -way],
                    [-along, -across, 0.0, way],
                ] {
                    let [vx, vy, wa, sense] = state;
                    let found = fastest(&|rate| solver.is_held_down(&[vx, vy, wa, sense * rate]));
                    assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");
                    let held = [vx, vy, wa, sense * 0.9 * expected];
                    let share = line_rates(dynamics, &held, 1e-2).share;
                    assert!(share > 0.0 && share < 1.0, "{share}");
                }
            }
        }
    }

    /// In a mirror across its axis a coin on its side tips onto the other rim whenever it tips onto this one.
    #[test]
    fn in_a_mirror_the_coin_tips_onto_the_other_rim() {
        let coin = Coin::cylinder(0.3, 0.01).expect("a valid coin");
        let surface = Surface::new(0.5, 0.4).expect("a valid surface");
        let scene = Scene::new(coin, surface, 9.81).expect("a valid scene");
        let settings = Settings {
            decision: Decision::Energy,
            ..Settings::default()
        };
        let model = model_of(&scene, &settings);
        let (solver, dynamics) = (model.contact_solver(Usage::default()), &model.dynamics);
        let exit = |state: &LineState| {
            let now = line_rates(dynamics, state, solver.rules.stick_speed);
            let (motion, spin) = line_motion(dynamics, state);
            let exit = match solver.side_exit(state, &now, &motion, &spin) {
                None => 0,
                Some(SideExit::TipsOntoThisRim) => 1,
                Some(SideExit::TipsOntoOtherRim) => -1,
                Some(SideExit::Leaves(exit)) => panic!("{exit:?} {state:?}"),
            };
            (exit, now.share)
        };
        let mut seen = [0; 4];
        for number in 0..6_000 {
            let mut dice = Dice::new(551, number);
            let roll = dice.between(0.2, 1.5);
            let [vx, slip, wz] = [0.0; 3].map(|_| {
                let size = dice.scale(1e-4, 1.0);
                dice.between(-size, size)
            });
            let axial = (slip - roll) / dynamics.body.radius;
            let (this, share) = exit(&[vx, roll, axial, wz]);
            let (other, rest) = exit(&[-vx, roll, axial, -wz]);
            assert!((share + rest - 1.0).abs() < 1e-9 * (1.0 + share.abs()));
            assert_eq!(this, -other, "{share} {vx} {slip} {wz}");
            // onto the rim alone that carries all of the weight
            assert!(this == 0 || (this == 1 && share >= 1.0) || (this == -1 && share <= 0.0));
            seen[usize::from(this != 0) + 2 * usize::from((0.0..1.0).contains(&share))] += 1;
        }
        assert!(seen[1] > 100 && seen[2] > 100, "{seen:?}");
    }

    /// A coin that rests on its side on a slope topples over its lower rim where the pull at its centre, at the height R,
    /// has more moment about it than the weight with the lever h.
    #[test]
    fn a_coin_on_its_side_topples_downhill_on_a_steep_slope() {
        let coin = Coin::cylinder(0.3, 0.01).expect("a valid coin");
        let surface = Surface::new(0.5, 0.4).expect("a valid surface");
        let scene = Scene::new(coin, surface, 9.81).expect("a valid scene");
        let model = model_of(&scene, &Settings::default());
        let level = model.contact_solver(Usage::default());
        for pull in [-0.2, -0.16, -0.14, -0.05, 0.05, 0.14, 0.16, 0.2] {
            let dynamics = model.dynamics.pulled_by([pull, 0.02]);
            let solver = level.with(&dynamics);
            // the lowest rim of the folded frame is the one at −x
            let found = [1.0, -1.0].map(|side| solver.tips(&[0.0; 4], side));
            assert_eq!(found, [pull < -0.15, pull > 0.15], "{pull}");
        }
    }

    /// More energy than there was is taken from all velocities alike, and no other state is changed.
    #[test]
    fn a_capped_state_has_no_more_energy() {
        let model = model_of(&generic_scene(|plane| plane), &Settings::default());
        let (solver, dynamics) = (model.contact_solver(Usage::default()), &model.dynamics);
        let state = [0.3, -0.5, 0.7, 1.1];
        let kinetic = |state: &LineState| {
            let (motion, spin) = line_motion(dynamics, state);
            motion.kinetic(&dynamics.body, &spin)
        };
        let energy = kinetic(&state);
        assert_eq!(solver.capped(state, 1.01 * energy), state);
        let capped = solver.capped(state, 0.36 * energy);
        for (found, before) in capped.into_iter().zip(state) {
            assert!((found / before - 0.6).abs() < 1e-14);
        }
    }
}

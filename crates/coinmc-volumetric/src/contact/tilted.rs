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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Usage;
    use crate::contact::on_side::tests::{rolls, rolls_plainly};
    use crate::contact::place;
    use crate::place::Place;
    use crate::settings::Settings;
    use crate::toss::tests::{generic_scene, model_of};
    use coinmc_core::{Coin, Decided, Scene, Surface, TableTilt};
    use coinmc_testkit::Dice;
    use coinmc_testkit::Recorder;
    use nalgebra::Vector3;

    /// With a share of the weight on each rim, and friction that holds it along its axis against the pull, the
    /// moments at the rims turn the coin's angular momentum with it, and do not tilt it.
    #[test]
    fn the_shares_of_a_held_coin_leave_no_moment_that_tilts_it() {
        let model = model_of(&generic_scene(|plane| plane), &Settings::default());
        for number in 0..100 {
            let mut dice = Dice::new(552, number);
            let mut rate = |size: f64| dice.between(-size, size);
            let dynamics = model.dynamics.pulled_by([rate(0.2), rate(0.2)]);
            let body = &dynamics.body;
            let state = [rate(1.0), rate(1.0), rate(1.0), rate(1.0)];
            let share = held_share(&dynamics, &state);
            let friction = -dynamics.pull.expect("a pull")[0];
            let torque: Vector3<f64> = [(share, -1.0), (1.0 - share, 1.0)]
                .into_iter()
                .map(|(normal, side)| {
                    let arm = Vector3::new(side * body.half, 0.0, -body.outer_radius());
                    arm.cross(&Vector3::new(friction * normal, 0.0, normal))
                })
                .sum();
            let momentum = Vector3::new(body.ka * state[2], 0.0, body.kt * state[3]);
            let turning = (Vector3::z() * state[3]).cross(&momentum);
            assert!((torque.y - turning.y).abs() < 1e-14, "{torque} {turning}");
        }
    }

    /// What is left of a creep when the coin rolls straight is what one impulse at the table leaves of it. Then it
    /// rolls as its equation of motion says, downhill farther than uphill, or for ever where the pull is more than
    /// contour friction.
    #[test]
    fn a_coin_rolls_on_a_slope_until_contour_friction_holds_it() {
        let model = model_of(&generic_scene(|plane| plane), &Settings::default());
        let body = &model.dynamics.body;
        let radius = body.outer_radius();
        let holds = model.dynamics.friction.contour / radius;
        let mut ways = Vec::new();
        for (speed, pull) in [
            (0.4, 0.5),
            (0.4, -0.5),
            (-0.4, 0.5),
            (-0.4, -0.5),
            (0.4, 1.1),
            (-0.4, 1.1),
        ] {
            let dynamics = model.dynamics.pulled_by([0.03, pull * holds]);
            let level = model.contact_solver(Usage {
                time: 1.5,
                ..Usage::default()
            });
            let mut solver = level.with(&dynamics);
            let mut state = rolls(&dynamics, speed);
            state[1] += 0.05;
            // p changes v_y by p and k_a ω_a by R p, and ends the slip
            let slip = state[1] + radius * state[2];
            let left = state[1] - slip / (1.0 + radius * radius / body.ka);

            let (mut motion, mut spin) = line_motion(&dynamics, &state);
            let mut place = Place::at([0.2, -0.1], [0.6, 0.8]);
            let before = place;
            let mut seen = Recorder::default();
            let mut adapter = ObserverAdapter {
                observer: &mut seen,
                place: &mut place,
                heads_up: false,
                units: &model.units,
            };
            let exit = solver.roll_down(&state, &mut motion, &mut spin, &mut adapter);
            let begun = &seen.0[0];
            assert_eq!(begun.kind, EventKind::Sticking);
            let shown = begun.state.velocity_m_s.norm() / model.units.speed_m_s();
            assert!((shown - left.abs()).abs() < 1e-14, "{shown} {left}");
            if pull.abs() > 1.0 {
                assert_eq!(exit, Exit::NeverSettles);
                continue;
            }
            assert_eq!(exit, Exit::Decided(Decided::Side));
            let ahead = pull * holds * left.signum();
            let (way, time) = rolls_plainly(&dynamics, left.abs(), ahead);
            let [x, y] = before.in_frame(place.way_from(&before));
            assert!(
                x.abs() < 1e-12 && (y / way.copysign(left) - 1.0).abs() < 1e-4,
                "{y} {way}"
            );
            for took in [place.time, solver.usage.time - 1.5] {
                assert!((took / time - 1.0).abs() < 1e-4, "{took} {time}");
            }
            ways.push(way);
        }
        assert!(ways[0] > 1.5 * ways[1] && ways[3] > 1.5 * ways[2]);
    }

    /// The pull of this table in a frame whose x axis is at the angle `heading` in the laboratory.
    fn seen_from(tilt: &TableTilt, heading: f64) -> [f64; 2] {
        let (sin, cos) = libm::sincos(heading);
        let [ex, ey] = tilt.downhill().map(|e| e * tilt.slope());
        [ex * cos + ey * sin, ey * cos - ex * sin]
    }

    /// Where these rates lead from `y` in a time, by many small steps of the classical Runge-Kutta method.
    fn followed<const N: usize>(
        rates: impl Fn(&[f64; N]) -> [f64; N],
        mut y: [f64; N],
        time: f64,
    ) -> [f64; N] {
        let count = 1_000;
        let h = time / f64::from(count);
        let ahead = |y: &[f64; N], k: &[f64; N], h: f64| {
            std::array::from_fn::<f64, N, _>(|i| y[i] + h * k[i])
        };
        for _ in 0..count {
            let k1 = rates(&y);
            let k2 = rates(&ahead(&y, &k1, 0.5 * h));
            let k3 = rates(&ahead(&y, &k2, 0.5 * h));
            let k4 = rates(&ahead(&y, &k3, h));
            y = std::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
        }
        y
    }

    /// So is a coin that rolls on its rim, leaning so much that its frame turns much faster than it does itself.
    #[test]
    fn a_coin_on_its_rim_rolls_as_the_pull_of_the_table_asks() {
        let tilt = TableTilt::new(8.0, 40.0).expect("a valid tilt");
        let surface = Surface::new(0.5, 1.5).and_then(|surface| surface.with_tilt(tilt));
        let coin = Coin::cylinder(0.4, 0.01).expect("a valid coin");
        let scene = Scene::new(coin, surface.expect("a valid surface"), 9.81);
        let settings = Settings {
            time_limit: 2.0,
            ..Settings::default()
        };
        let model = model_of(&scene.expect("a valid scene"), &settings);
        let (dynamics, pull) = (&model.dynamics, model.pull.expect("a pull"));
        for (begun, start) in [
            (0.4, [0.6, 0.0, 0.3, -1.4, 0.0, 0.0]),
            (-2.0, [0.5, 0.1, -0.3, 1.3, 0.0, 0.0]),
        ] {
            let (mut motion, mut spin) = (Motion::still(), Spin::still());
            place(dynamics, &start, &mut motion, &mut spin);
            let (sin, cos) = libm::sincos(begun);
            let mut at = Place::at([0.2, -0.1], [cos, sin]);
            let mut seen = Recorder::default();
            let mut adapter = ObserverAdapter {
                observer: &mut seen,
                place: &mut at,
                heads_up: true,
                units: &model.units,
            };
            let mut solver = model.contact_solver(Usage::default());
            let exit = solver.follow_pulled(&pull, &mut motion, &mut spin, &mut adapter);
            assert_eq!(exit, Exit::TimeLimit);
            assert!(seen.0.iter().all(|event| event.kind == EventKind::Sticking));

            // the state, the heading, and the place of the centre
            let rates = |y: &[f64; 9]| {
                let state = std::array::from_fn(|i| y[i]);
                let pulled = dynamics.pulled_by(seen_from(&tilt, y[6]));
                let [a, b, c, d, e, f] = pulled.rates(&state, Mode::Stick).state;
                let (mut motion, mut spin) = (Motion::still(), Spin::still());
                place(&pulled, &state, &mut motion, &mut spin);
                let (sin, cos) = libm::sincos(y[6]);
                let (x, y) = (
                    motion.vx * cos - motion.vy * sin,
                    motion.vx * sin + motion.vy * cos,
                );
                [a, b, c, d, e, f, -spin.turn / motion.sin, x, y]
            };
            let [a, b, c, d, e, f] = start;
            let y = followed(rates, [a, b, c, d, e, f, begun, 0.2, -0.1], at.time);
            let [px, py] = at.point(0.0, 0.0);
            let (sin, cos) = libm::sincos(y[6]);
            let [hx, hy] = at.direction(1.0, 0.0);
            let off = [
                px - y[7],
                py - y[8],
                hx - cos,
                hy - sin,
                motion.sin - libm::sin(y[0]),
                spin.tilt - y[1],
                spin.axial - y[2],
                spin.turn - y[3],
            ];
            assert!((y[6] - begun).abs() > 3.0 && y[0] < 1.2, "{y:?}");
            assert!(off.iter().all(|off| off.abs() < 2e-3), "{off:?}");
        }
    }

    /// A coin that slides and turns on its side of a tilted table is, after a while, where many small steps of the
    /// classical Runge-Kutta method in the laboratory take it. The pull of each step, taken in its middle, is good to
    /// second order.
    #[test]
    fn a_coin_on_its_side_slides_as_the_pull_of_the_table_asks() {
        let tilt = TableTilt::new(8.0, 40.0).expect("a valid tilt");
        let surface = Surface::new(0.5, 0.3).and_then(|surface| surface.with_tilt(tilt));
        let coin = Coin::cylinder(3.0, 0.01).expect("a valid coin");
        let scene = Scene::new(coin, surface.expect("a valid surface"), 9.81);
        let settings = Settings {
            time_limit: 1.2,
            ..Settings::default()
        };
        let model = model_of(&scene.expect("a valid scene"), &settings);
        let (dynamics, pull) = (&model.dynamics, model.pull.expect("a pull"));
        for (begun, start) in [(0.4, [0.3, -0.7, 0.4, 2.5]), (-2.0, [-0.2, 0.6, 0.5, -3.0])] {
            let (mut motion, mut spin) = line_motion(dynamics, &start);
            let (sin, cos) = libm::sincos(begun);
            let mut place = Place::at([0.2, -0.1], [cos, sin]);
            let mut adapter = ObserverAdapter {
                observer: &mut Recorder::default(),
                place: &mut place,
                heads_up: true,
                units: &model.units,
            };
            let mut solver = model.contact_solver(Usage::default());
            let exit = solver.follow_on_side_pulled(&pull, &mut motion, &mut spin, &mut adapter);
            assert!(matches!(exit, SideExit::Leaves(Exit::TimeLimit)));
            assert!((solver.usage.time - place.time).abs() < 1e-12);

            // v_x, v_y, ω_a, ω_z of the frame, its heading, and the place of the centre
            let rates = |y: &[f64; 7]| {
                let (sin, cos) = libm::sincos(y[4]);
                let pull = seen_from(&tilt, y[4]);
                let state = [y[0], y[1], y[2], y[3]];
                let [ax, ay, aa, az] =
                    line_rates(&dynamics.pulled_by(pull), &state, settings.stick_speed).rates;
                let (x, y) = (y[0] * cos - y[1] * sin, y[0] * sin + y[1] * cos);
                [ax, ay, aa, az, state[3], x, y]
            };
            let [vx, vy, wa, wz] = start;
            let y = followed(rates, [vx, vy, wa, wz, begun, 0.2, -0.1], place.time);
            let [px, py] = place.point(0.0, 0.0);
            let (sin, cos) = libm::sincos(y[4]);
            let [hx, hy] = place.direction(1.0, 0.0);
            let off = [
                px - y[5],
                py - y[6],
                hx - cos,
                hy - sin,
                motion.vx - y[0],
                motion.vy - y[1],
                spin.axial - y[2],
                -spin.turn - y[3],
            ];
            assert!(off.iter().all(|off| off.abs() < 2e-3), "{off:?}");
        }
    }
}

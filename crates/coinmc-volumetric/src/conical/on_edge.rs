//! The path of a conical coin on its edge, until its face is decided or it tips onto one rim.

use super::Conical;
use super::edge::{Edge, EdgeRates, EdgeState};
use crate::contact::{
    ContactSolver, Exit, RollingStop, Usage, is_accepted, next_length, shorter, step,
};
use crate::observer_adapter::ObserverAdapter;
use crate::toss::Toss;
use crate::transition::Transition;
use coinmc_core::{Decided, EventKind, Observer};

/// Length of the first step.
const FIRST_STEP: f64 = 0.01;
/// Largest turn of the axis within a piece of the way to rest that an observer is shown, rad.
const LARGEST_TURN: f64 = 0.2;
/// Most pieces of a roll to rest, 33,000 rounds about the apex: of longer ones, with next to no rolling friction, the place is
/// shown less well.
const MOST_PIECES: f64 = 1_048_576.0;

/// How a coin comes to lie on its edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum FromRim {
    /// It rocks no longer.
    Rocking,
    /// It had tipped onto one rim, and the other one touches without any time between: it tips again only after
    /// a step on its edge.
    AtOnce,
}

/// How contact on the edge ends.
#[derive(Debug, Clone, Copy, PartialEq)]
enum EdgeExit {
    TipsOntoThisRim,
    TipsOntoOtherRim,
    /// Both rims press, and will until the coin, rolling about the apex, rests.
    RollsToRest,
    Leaves(Exit),
}

impl<L> Conical<L> {
    /// Lays the coin on its edge, and follows contact of both rims to its end.
    pub(super) fn lie_on_edge<O: Observer>(
        &self,
        toss: &mut Toss,
        usage: &mut Usage,
        from: FromRim,
        observer: &mut O,
    ) -> Transition {
        let model = self.model(toss);
        model.note_contact(toss);
        self.touch_with_edge(toss);
        let mut path = self.path(toss, *usage);
        let (motion, spin, mut adapter) = toss.observed(&model.units, observer);
        let mut state = Edge::state(motion, spin);
        let exit = path.follow(&mut state, from, &mut adapter);
        *usage = path.solver.usage;
        path.edge.place(&model.dynamics, &state, motion, spin);
        match exit {
            EdgeExit::TipsOntoThisRim => Transition::Contact,
            EdgeExit::TipsOntoOtherRim => {
                toss.turn_over();
                Transition::Contact
            }
            EdgeExit::RollsToRest => model.after_contact(toss, Exit::Decided(Decided::Side)),
            EdgeExit::Leaves(exit) => model.after_contact(toss, exit),
        }
    }

    fn path(&self, toss: &Toss, usage: Usage) -> Path<'_> {
        let [this, other] = if toss.heads_up { [0, 1] } else { [1, 0] };
        let (this_model, other_model) = (&self.models[this], &self.models[other]);
        Path {
            edge: self.edges[this],
            tilts: [
                self.models[this].edge_tilt(),
                self.models[other].edge_tilt(),
            ],
            solver: this_model.contact_solver(usage),
            other: other_model.contact_solver(usage),
        }
    }
}

/// The coin on its edge.
struct Path<'a> {
    edge: Edge,
    /// Tilts of the coin on its edge, in the frames of both rims.
    tilts: [f64; 2],
    solver: ContactSolver<'a>,
    /// The solver of the other rim.
    other: ContactSolver<'a>,
}

impl Path<'_> {
    /// Follows the coin from `state`, which is left where contact on the edge ends. Rolling about the apex
    /// is shown as sticking.
    fn follow<O: Observer>(
        &mut self,
        state: &mut EdgeState,
        from: FromRim,
        adapter: &mut ObserverAdapter<'_, O>,
    ) -> EdgeExit {
        let mut may_tip = from != FromRim::AtOnce;
        let (dynamics, creep) = (self.solver.rules.dynamics, self.solver.rules.stick_speed);
        let edge = self.edge;
        let mut length = FIRST_STEP;
        if O::ACTIVE && !self.rolls(state) {
            let (motion, spin) = edge.motion(dynamics, state);
            adapter.event(EventKind::Sliding, &motion, &spin);
        }
        loop {
            let now = edge.rates(dynamics, state, creep);
            let tips = |exit: &EdgeExit| {
                matches!(exit, EdgeExit::TipsOntoThisRim | EdgeExit::TipsOntoOtherRim)
            };
            let exit = self.exit(state, &now);
            if let Some(exit) = exit.filter(|exit| may_tip || !tips(exit)) {
                if exit == EdgeExit::RollsToRest {
                    self.roll_to_rest(state, adapter);
                }
                return exit;
            }
            may_tip = true;
            let ceiling = self.kinetic(state);
            loop {
                self.solver.usage.steps += 1;
                let number = f64::from(self.solver.usage.steps);
                if !self.solver.rules.limits.allow_step(length, number) {
                    return EdgeExit::Leaves(Exit::GivenUp);
                }
                let trial = self.step(state, &now.rates, length);
                if is_accepted(trial.error) {
                    let start = *state;
                    adapter.step(length, |t| {
                        let state = self.step(&start, &now.rates, t).state;
                        edge.motion(dynamics, &self.capped(state, ceiling))
                    });
                    *state = self.capped(trial.state, ceiling);
                    self.solver.usage.time += length;
                    length = next_length(length, trial.error);
                    break;
                }
                length = shorter(length, trial.error);
            }
            if O::ACTIVE && adapter.observer.has_seen_enough() {
                return EdgeExit::Leaves(Exit::GivenUp);
            }
        }
    }

    fn step(
        &self,
        state: &EdgeState,
        rates: &EdgeState,
        length: f64,
    ) -> crate::contact::Trial<f64, 4> {
        let rules = &self.solver.rules;
        let flow = |at: &EdgeState| self.edge.rates(rules.dynamics, at, rules.stick_speed).rates;
        step(state, rates, length, rules.tolerance, flow)
    }

    /// Whether the coin rolls about the apex, apart from a creep.
    fn rolls(&self, state: &EdgeState) -> bool {
        let rules = &self.solver.rules;
        rules.dynamics.friction.mu > 0.0 && self.edge.slip(state) < rules.creep
    }

    fn exit(&self, state: &EdgeState, now: &EdgeRates) -> Option<EdgeExit> {
        let rules = &self.solver.rules;
        let (motion, spin) = self.edge.motion(rules.dynamics, state);
        let decided = rules.decide(&motion, &spin);
        if decided != Decided::Open {
            return Some(EdgeExit::Leaves(Exit::Decided(decided)));
        }
        // a NaN tips neither way, and is found by the integrator
        if now.share >= 1.0 && self.tips_onto_this_rim(state) {
            return Some(EdgeExit::TipsOntoThisRim);
        }
        if now.share <= 0.0 && self.tips_onto_other_rim(state) {
            return Some(EdgeExit::TipsOntoOtherRim);
        }
        let (dynamics, tilting) = (rules.dynamics, rules.rule.is_tilting());
        if tilting && self.edge.overturning(dynamics, state) <= self.edge.shorter_reach() {
            return Some(EdgeExit::Leaves(Exit::Decided(Decided::Side)));
        }
        if self.rolls(state) && 0.0 < now.share && now.share < 1.0 {
            let rolling = self.rolling_stop(state);
            return Some(if rolling.stops() {
                EdgeExit::RollsToRest
            } else if rolling.slows() || tilting {
                // by drag alone it never quite rests; without any loss it rolls for ever
                EdgeExit::Leaves(Exit::Decided(Decided::Side))
            } else {
                EdgeExit::Leaves(Exit::NeverSettles)
            });
        }
        let late = rules.limits.is_late(self.solver.usage.time);
        late.then_some(EdgeExit::Leaves(Exit::TimeLimit))
    }

    /// Whether contact of one rim alone agrees that the coin tips onto it. (Friction that makes a rim stick
    /// may differ from the friction of its creep.)
    fn tips_onto_this_rim(&self, state: &EdgeState) -> bool {
        let ([vx, _, axial, turn], [slip, _]) = (*state, self.edge.slips(state));
        let rim = [self.tilts[0], 0.0, axial, turn, vx, slip];
        self.solver.tilts_from_side(rim)
    }

    fn tips_onto_other_rim(&self, state: &EdgeState) -> bool {
        let ([vx, _, axial, turn], [_, slip]) = (*state, self.edge.slips(state));
        let rim = [self.tilts[1], 0.0, -axial, turn, -vx, -slip];
        self.other.tilts_from_side(rim)
    }

    fn kinetic(&self, state: &EdgeState) -> f64 {
        let dynamics = self.solver.rules.dynamics;
        let (motion, spin) = self.edge.motion(dynamics, state);
        motion.kinetic(&dynamics.body, &spin)
    }

    /// The state with no more kinetic energy than `ceiling`.
    fn capped(&self, state: EdgeState, ceiling: f64) -> EdgeState {
        let kinetic = self.kinetic(&state);
        if kinetic > ceiling {
            let scale = (ceiling / kinetic).sqrt();
            state.map(|x| x * scale)
        } else {
            state
        }
    }

    fn rolling_stop(&self, state: &EdgeState) -> RollingStop {
        self.edge
            .rolling_stop(self.solver.rules.dynamics, state[1].abs())
    }

    /// The end of rolling about the apex, in closed form; the creep decays together with it.
    fn roll_to_rest<O: Observer>(
        &mut self,
        state: &mut EdgeState,
        adapter: &mut ObserverAdapter<'_, O>,
    ) {
        let (dynamics, edge) = (self.solver.rules.dynamics, self.edge);
        let rolling = self.rolling_stop(state);
        let (motion, spin) = edge.motion(dynamics, state);
        adapter.event(EventKind::Sticking, &motion, &spin);
        let azimuth = (state[3] / edge.sin).abs();
        let turns = (azimuth * rolling.time / LARGEST_TURN).ceil();
        let pieces = if O::ACTIVE {
            rolling.pieces().max(turns).min(MOST_PIECES)
        } else {
            1.0
        };
        let duration = rolling.time / pieces;
        let mut begun = 0.0;
        while begun < pieces {
            let start = begun * duration;
            adapter.step(duration, |t| {
                let left = rolling.left(start + t);
                edge.motion(dynamics, &state.map(|rate| rate * left))
            });
            begun += 1.0;
        }
        self.solver.usage.time += rolling.time;
        *state = [0.0; 4];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::Moreau;
    use crate::place::Place;
    use crate::settings::{Decision, Settings};
    use coinmc_core::{Coin, Drag, Scene, Surface};
    use coinmc_testkit::{Dice, Recorder};

    /// A thin conical coin with this friction, contour friction (m) and linear drag (1/s).
    fn conical(settings: &Settings, friction: f64, contour_m: f64, drag: f64) -> Conical<Moreau> {
        let coin = Coin::cylinder(0.3, 0.012).and_then(|coin| coin.with_draft(9.0));
        let surface = Surface::new(0.5, friction)
            .and_then(|surface| surface.with_friction_lengths(contour_m, 0.3 * contour_m));
        let scene = Scene::new(
            coin.expect("a valid coin"),
            surface.expect("a valid surface"),
            9.81,
        );
        let drag = Drag::new(drag, drag).expect("a valid drag");
        let scene = scene.expect("a valid scene").with_drag(drag);
        let conical = Conical::new(&scene, settings, Moreau).expect("valid settings");
        conical.expect("unlike faces")
    }

    /// By the decision on energy alone.
    fn by_energy() -> Settings {
        Settings {
            decision: Decision::Energy,
            ..Settings::default()
        }
    }

    fn heads_up(heads_up: bool) -> Toss {
        Toss {
            heads_up,
            ..Toss::still()
        }
    }

    /// Turning about its line of contact alone, at this rate.
    fn rolls(edge: &Edge, omega: f64) -> EdgeState {
        [
            0.0,
            -edge.height * omega,
            edge.sin * omega,
            edge.cos * omega,
        ]
    }

    /// Rolling to rest leads along a circle about the apex, at the distance ζ s/c of the centre from it, by the way in
    /// which friction takes the energy.
    #[test]
    fn the_coin_rolls_to_rest_along_a_circle_about_the_apex() {
        let conical = conical(&Settings::default(), 0.4, 1e-3, 0.0);
        for up in [false, true] {
            let toss = heads_up(up);
            let mut path = conical.path(&toss, Usage::default());
            path.solver.usage.time = 0.7;
            let edge = path.edge;
            for azimuth in [-6.0, 6.0] {
                let mut state = rolls(&edge, azimuth * edge.sin / edge.cos);
                let mut place = Place::at([0.3, -0.2], [0.6, 0.8]);
                let before = place;
                let units = conical.model(&toss).units;
                let mut adapter = ObserverAdapter {
                    observer: &mut Recorder::default(),
                    place: &mut place,
                    heads_up: up,
                    units: &units,
                };
                let energy = path.kinetic(&state);
                let begun = path.solver.usage.time;
                path.roll_to_rest(&mut state, &mut adapter);
                assert_eq!(state, [0.0; 4]);
                let took = path.solver.usage.time - begun;
                assert!((place.time / took - 1.0).abs() < 1e-9);
                // the energy ends at ρ_c/s for each radian of roll, half as fast on the average as at first
                let dynamics = path.solver.rules.dynamics;
                let roll = energy / (dynamics.friction.contour / edge.sin);
                let omega = azimuth.abs() * edge.sin / edge.cos.abs();
                assert!((0.5 * omega * took / roll - 1.0).abs() < 1e-9);
                // the axis leans along x: the apex lies there, on this side or on that
                let angle = -(roll * edge.cos.abs() / edge.sin).copysign(azimuth);
                let apex = edge.height * edge.sin / edge.cos;
                let (sin, cos) = libm::sincos(angle);
                let way = before.in_frame(place.way_from(&before));
                let expected = [apex * (cos - 1.0), apex * sin];
                let [hx, hy] = before.in_frame(place.direction(1.0, 0.0));
                for (found, expected) in [
                    (way[0], expected[0]),
                    (way[1], expected[1]),
                    (hx, cos),
                    (hy, sin),
                ] {
                    assert!(
                        (found - expected).abs() < 1e-4 * apex.abs(),
                        "{found} {expected}"
                    );
                }
            }
        }
    }

    /// Seen from its other rim it is the same coin: it tips onto this one there where it tips onto the other one
    /// here, and only if the weight is all on one rim.
    #[test]
    fn both_rims_agree_on_which_of_them_the_coin_tips_onto() {
        let conical = conical(&by_energy(), 0.4, 1e-4, 0.0);
        let paths = [true, false].map(|up| conical.path(&heads_up(up), Usage::default()));
        let creep = paths[0].solver.rules.stick_speed;
        let exit = |path: &Path<'_>, state: &EdgeState| {
            let now = path.edge.rates(path.solver.rules.dynamics, state, creep);
            (path.exit(state, &now), now.share)
        };
        let mut seen = [0; 4];
        for number in 0..6_000 {
            let mut dice = Dice::new(560, number);
            let mut state = rolls(&paths[0].edge, dice.between(0.3, 1.5));
            for rate in &mut state {
                let size = dice.scale(1e-4, 1.0);
                *rate += dice.between(-size, size);
            }
            let [vx, vy, axial, turn] = state;
            let (this, share) = exit(&paths[0], &state);
            let (other, rest) = exit(&paths[1], &[-vx, -vy, -axial, turn]);
            assert!((share + rest - 1.0).abs() < 1e-9 * (1.0 + share.abs()));
            let expected = match this {
                Some(EdgeExit::TipsOntoThisRim) => {
                    assert!(share >= 1.0);
                    Some(EdgeExit::TipsOntoOtherRim)
                }
                Some(EdgeExit::TipsOntoOtherRim) => {
                    assert!(share <= 0.0);
                    Some(EdgeExit::TipsOntoThisRim)
                }
                same => same,
            };
            assert_eq!(other, expected, "{share}");
            let tips = this != expected;
            seen[usize::from(tips) + 2 * usize::from((0.0..1.0).contains(&share))] += 1;
        }
        assert!(seen[1] > 100 && seen[2] > 100, "{seen:?}");
    }

    /// A coin that rolls about the apex rests in the end by contour friction. By drag alone it is on its side
    /// though it never quite rests; without any loss it rolls for ever, unless what cannot tilt it is left out. Without
    /// friction nothing rolls, and neither does what slips faster than a creep.
    #[test]
    fn rolling_about_the_apex_ends_by_its_losses() {
        let side = EdgeExit::Leaves(Exit::Decided(Decided::Side));
        let for_ever = EdgeExit::Leaves(Exit::NeverSettles);
        for (settings, contour_m, drag, expected) in [
            (by_energy(), 1e-4, 0.0, EdgeExit::RollsToRest),
            (by_energy(), 0.0, 0.1, side),
            (by_energy(), 0.0, 0.0, for_ever),
            (Settings::default(), 0.0, 0.0, side),
        ] {
            for up in [false, true] {
                let conical = conical(&settings, 0.4, contour_m, drag);
                let path = conical.path(&heads_up(up), Usage::default());
                let state = rolls(&path.edge, 0.6);
                let (dynamics, creep) = (path.solver.rules.dynamics, settings.stick_speed);
                let now = path.edge.rates(dynamics, &state, creep);
                assert_eq!(path.exit(&state, &now), Some(expected));
                let mut slips = state;
                slips[0] = 0.99 * creep;
                assert!(path.rolls(&state) && path.rolls(&slips));
                slips[0] = 1.01 * creep;
                assert!(!path.rolls(&slips));
            }
        }
        let slippery = conical(&by_energy(), 0.0, 0.0, 0.0);
        let path = slippery.path(&heads_up(true), Usage::default());
        assert!(!path.rolls(&rolls(&path.edge, 0.6)));
    }

    /// A coin that rolls is shown to roll at once, and one that slips is shown to slide first.
    #[test]
    fn a_coin_that_rolls_is_not_shown_to_slide() {
        let conical = conical(&Settings::default(), 0.4, 1e-3, 0.0);
        let toss = heads_up(true);
        let units = conical.model(&toss).units;
        for (slip, expected) in [(0.0, EventKind::Sticking), (0.1, EventKind::Sliding)] {
            let mut path = conical.path(&toss, Usage::default());
            let mut state = rolls(&path.edge, 0.6);
            state[0] = slip;
            let mut seen = Recorder::default();
            let mut adapter = ObserverAdapter {
                observer: &mut seen,
                place: &mut Place::origin([1.0, 0.0]),
                heads_up: true,
                units: &units,
            };
            path.follow(&mut state, FromRim::Rocking, &mut adapter);
            assert_eq!(seen.0[0].kind, expected);
        }
    }

    /// A coin on its edge is followed for as many steps as are allowed, over which its energy never grows.
    #[test]
    fn steps_on_the_edge_are_counted() {
        let settings = Settings {
            max_steps: 7,
            ..by_energy()
        };
        let conical = conical(&settings, 0.4, 1e-4, 0.0);
        let toss = heads_up(true);
        let mut path = conical.path(&toss, Usage::default());
        let mut state = rolls(&path.edge, 0.6);
        state[1] += 0.1;
        let before = path.kinetic(&state);
        let units = conical.model(&toss).units;
        let mut place = Place::origin([1.0, 0.0]);
        let mut adapter = ObserverAdapter {
            observer: &mut Recorder::default(),
            place: &mut place,
            heads_up: true,
            units: &units,
        };
        let exit = path.follow(&mut state, FromRim::Rocking, &mut adapter);
        assert_eq!(exit, EdgeExit::Leaves(Exit::GivenUp));
        assert_eq!(path.solver.usage.steps, 7);
        assert!(path.kinetic(&state) < before && path.solver.usage.time > 0.0);
        assert!((place.time / path.solver.usage.time - 1.0).abs() < 1e-12);
    }
}

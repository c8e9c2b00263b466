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
            rolling.pieces().max(turns)
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

//! One coin on rough ground: its state, and the loop from node to node and from event to event.

use super::ground::Ground;
use super::tracks::{Tracks, carried_now, rim_points};
use crate::body::Body;
use crate::contact::{ContactSolver, Usage};
use crate::flight::Departure;
use crate::impact::ImpactLaw;
use crate::model::Model;
use crate::motion::{Motion, Spin};
use crate::place::Place;
use crate::toss::Toss;
use crate::transition::Transition;
use coinmc_core::{Decided, Ended, Observer};

/// A coin that is flatter than this sine of its tilt touches with a long arc of its rim, and the
/// ground under it counts as a plane.
pub(crate) const FLATTEST: f64 = 0.2;

/// What touches the ground.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Touch {
    /// Nothing: a low hop.
    Nothing,
    /// The own rim.
    Rim,
    /// Both rims: the coin is on its side.
    Both,
}

/// What the walk does next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Next {
    /// Goes on like this.
    Goes(Touch),
    /// The own rim has come down.
    Impact,
    /// Ends.
    Ends(Transition),
}

/// A coin close to rough ground. `motion` is that of the laboratory: z above the mean of the ground;
/// and while the other rim is on a bump, the axis of the folded frame may point down, cos < 0.
pub(super) struct Walk<'a, I, O> {
    pub(super) model: &'a Model<I>,
    pub(super) ground: &'a Ground,
    pub(super) toss: &'a mut Toss,
    pub(super) usage: &'a mut Usage,
    pub(super) observer: &'a mut O,
    /// Where the coin is on the ground.
    pub(super) place: Place,
    pub(super) tracks: Tracks,
    /// The mechanical energy that is left. It never grows; see [`balance`](super::balance).
    pub(super) budget: f64,
    /// Kinetic energy that slopes have given ahead of the way down: see [`slopes`](super::slopes).
    pub(super) lead: f64,
    /// How far ahead of its lowest point the own rim touches, in the interval under way.
    pub(super) ahead: f64,
    /// Since when a coin with both rims down has been almost at rest.
    pub(super) at_rest_since: Option<f64>,
}

impl<I: ImpactLaw> Model<I> {
    /// Follows a coin that has just landed on rough ground, until it flies again, the other rim is
    /// clear of the ground in sustained contact, or the toss ends.
    pub(crate) fn land_on<O: Observer>(
        &self,
        ground: &Ground,
        toss: &mut Toss,
        usage: &mut Usage,
        observer: &mut O,
    ) -> Transition {
        if self.limits.no_impact_left(toss.impacts) {
            return Transition::End(Ended::ImpactLimit);
        }
        toss.impacts += 1;
        Walk::above_ground(self, ground, toss, usage, observer).land()
    }

    /// The same for a coin in sustained contact whose other rim has come near the ground.
    pub(crate) fn near_ground<O: Observer>(
        &self,
        toss: &mut Toss,
        solver: &mut ContactSolver<'_>,
        observer: &mut O,
    ) -> Transition {
        // only rough ground leads here
        let Some(ground) = &self.ground else {
            return Transition::End(self.end_given_up(toss));
        };
        let mut walk = Walk::above_ground(self, ground, toss, &mut solver.usage, observer);
        walk.put_down();
        walk.follow(Next::Goes(Touch::Rim))
    }
}

impl<'a, I: ImpactLaw, O: Observer> Walk<'a, I, O> {
    /// A coin at a random place of the ground, and at the height 0 until it is [put down](Self::put_down).
    pub(super) fn above_ground(
        model: &'a Model<I>,
        ground: &'a Ground,
        toss: &'a mut Toss,
        usage: &'a mut Usage,
        observer: &'a mut O,
    ) -> Self {
        let (place, _) = ground.random_place(&toss.motion, 0);
        let budget = toss.motion.energy(&model.dynamics.body, &toss.spin);
        Self {
            model,
            ground,
            toss,
            usage,
            observer,
            place,
            tracks: Tracks::default(),
            budget,
            lead: 0.0,
            ahead: 0.0,
            at_rest_since: None,
        }
    }

    /// Puts the coin onto the ground that is under its own rim.
    fn put_down(&mut self) {
        let (motion, spin) = (&self.toss.motion, &self.toss.spin);
        let under = Tracks::begin(self.ground, self.body(), motion, spin, &self.place).own;
        self.tracks.own.height += under.height;
        self.toss.motion.z += under.height;
        self.toss.place.lower_datum(under.height);
        self.budget += under.height;
    }

    /// Lets the other rim land where the ground under it is so much higher that it touches first; returns
    /// whether it does.
    fn land_first_rim(&mut self) -> bool {
        let (motion, spin, body) = (&self.toss.motion, &self.toss.spin, self.body());
        if motion.cos >= self.ground.near {
            return false;
        }
        let points = rim_points(body, motion, spin);
        let [own, other] = points.map(|point| {
            let (height, _) = carried_now(self.ground, body, motion, &self.place, point.rx);
            height
        });
        let above = 2.0 * body.half * motion.cos;
        let comes_down = spin.tilt * points[1].rx - motion.vz >= 0.0;
        let other_first = other - own > above && comes_down;
        if other_first {
            self.toss.motion.z -= above;
            self.toss.place.lower_datum(-above);
            self.budget -= above;
            self.switch_rim();
        }
        other_first
    }

    /// The landing of a coin above the ground. Most coins fly on at once, and need no heights.
    fn land(&mut self) -> Transition {
        let mut slopes = self.draw_place();
        if self.land_first_rim() {
            slopes = self.slopes_under_rim();
        }
        let (motion, spin) = (self.toss.motion, self.toss.spin);
        let time = self.time_between_nodes();
        self.tracks = Tracks::level(time);
        let next = self.collide_with(slopes);
        if next == Next::Ends(Transition::Flight(Departure::Rebound)) && self.lies_on_face() {
            return Transition::End(self.toss.ended(Decided::Face));
        }
        if !matches!(next, Next::Ends(_)) {
            self.put_down();
            let landed = self.tracks.own;
            let body = &self.model.dynamics.body;
            self.tracks
                .lay_out(self.ground, time, body, &motion, &spin, &self.place);
            self.tracks.keep_landing(&landed);
        }
        self.follow(next)
    }

    pub(super) fn body(&self) -> &Body {
        &self.model.dynamics.body
    }

    fn follow(&mut self, mut next: Next) -> Transition {
        loop {
            if let Next::Ends(transition) = next {
                self.leave();
                return transition;
            }
            next = self.go_on(next);
        }
    }

    /// Does what is next.
    fn go_on(&mut self, next: Next) -> Next {
        match next {
            Next::Impact => self.collide(),
            Next::Goes(touch) => {
                if touch != Touch::Nothing {
                    self.model.note_contact(self.toss);
                }
                if let Some(end) = self.end_now(touch) {
                    return Next::Ends(end);
                }
                match touch {
                    Touch::Nothing => self.hop(),
                    Touch::Rim => self.roll_on_rim(),
                    Touch::Both => self.roll_on_both(),
                }
            }
            Next::Ends(_) => next,
        }
    }

    /// The end of a toss that is decided or at a limit.
    fn end_now(&mut self, touch: Touch) -> Option<Transition> {
        let limits = &self.model.limits;
        let given_up = limits.no_step_left(self.usage.steps)
            || !self.budget.is_finite()
            || (O::ACTIVE && self.observer.has_seen_enough());
        if given_up {
            Some(Transition::End(self.model.end_given_up(self.toss)))
        } else if limits.is_late(self.usage.time) {
            Some(Transition::End(Ended::TimeLimit))
        } else {
            self.decide(touch)
                .map(|decided| Transition::End(self.toss.ended(decided)))
        }
    }

    /// The height of the other rim above its track.
    pub(super) fn gap_of_other(&self) -> f64 {
        2.0 * self.body().half * self.toss.motion.cos + self.tracks.own.height
            - self.tracks.other.height
    }

    /// Whether the coin leans so far, and will until the next node, that the plane serves.
    pub(super) fn is_clear(&self) -> bool {
        /// The share by which the lean must exceed that at which the ground is felt.
        const CLEAR: f64 = 1.1;
        let reached = self.toss.spin.tilt.max(0.0) * self.tracks.interval;
        let lean = self.toss.motion.cos - reached;
        // what a plane decides for the side is decided here, not on the plane
        lean > CLEAR * self.ground.felt && {
            let motion = self.relative_motion();
            let state = motion.decision_state(self.body(), &self.toss.spin);
            self.model.rule.decide(&state) != Decided::Side
        }
    }

    /// The speed at which the own rim approaches the mean ground.
    pub(super) fn approach(&self) -> f64 {
        let [own, _] = rim_points(self.body(), &self.toss.motion, &self.toss.spin);
        self.toss.spin.tilt * own.rx - self.toss.motion.vz
    }

    /// How far ahead of its lowest point a rim touches ground of these slopes: where the ground is as steep
    /// as the rim.
    pub(super) fn ahead_with(&self, [_, steep]: [f64; 2]) -> f64 {
        steep * self.body().outer_radius() / self.toss.motion.sin
    }

    /// The motion relative to a level ground at the height of the own track that rises with it.
    pub(super) fn relative_motion(&self) -> Motion<f64> {
        let [own, _] = rim_points(self.body(), &self.toss.motion, &self.toss.spin);
        Motion {
            vz: self.toss.motion.vz - self.tracks.own.rate,
            z: -own.rz,
            ..self.toss.motion
        }
    }

    /// Sets the motion from one relative to the ground at the own track.
    pub(super) fn set_relative(&mut self, motion: Motion<f64>, spin: Spin<f64>) {
        let track = self.tracks.own;
        self.toss.motion = Motion {
            vz: motion.vz + track.rate,
            z: motion.z + track.height,
            ..motion
        };
        self.toss.spin = spin;
    }

    /// Lays out tracks from where the coin is, after a way without any.
    pub(super) fn begin_tracks(&mut self) {
        let (motion, spin) = (&self.toss.motion, &self.toss.spin);
        self.tracks = Tracks::begin(self.ground, self.body(), motion, spin, &self.place);
        self.lay_out_tracks();
    }

    pub(super) fn lay_out_tracks(&mut self) {
        self.lay_out_tracks_for(self.time_between_nodes());
    }

    /// Lays out the tracks up to a node in `time` from now.
    pub(super) fn lay_out_tracks_for(&mut self, time: f64) {
        let (motion, spin) = (&self.toss.motion, &self.toss.spin);
        let body = &self.model.dynamics.body;
        self.tracks
            .lay_out(self.ground, time, body, motion, spin, &self.place);
    }

    pub(super) fn time_between_nodes(&self) -> f64 {
        let (motion, spin) = (&self.toss.motion, &self.toss.spin);
        let step = self.model.ground_step * self.ground.length * self.stride();
        Tracks::time_between_nodes(step, self.body(), motion, spin)
    }

    /// How many times as far apart as usual the nodes may be.
    ///
    /// Bumps under one rim take a rolling coin at most ½ s²w² of energy on a way ℓ, and rolling friction
    /// takes ℓ ρ_c/R. Where the bumps take less, a coin that leans far is moved by friction, not by them.
    fn stride(&self) -> f64 {
        /// Leaning farther than this share of the lean at which it topples, the coin does not fall or rise
        /// for the sake of a few bumps.
        const LEANS: f64 = 0.5;
        const LONGEST: f64 = 8.0;
        let (body, ground, spin) = (self.body(), self.ground, &self.toss.spin);
        let upright = ground.near.max(LEANS * body.half);
        if self.toss.motion.cos <= upright + spin.tilt.abs() * self.tracks.interval {
            return 1.0;
        }
        let [own, _] = rim_points(body, &self.toss.motion, spin);
        let bumps = 0.5 * (ground.slope() * own.speed()).powi(2);
        let contour = self.model.dynamics.friction.contour;
        let friction = ground.length * contour / body.outer_radius();
        (friction / bumps.max(f64::MIN_POSITIVE))
            .sqrt()
            .clamp(1.0, LONGEST)
    }

    /// Makes the other rim the own one, by reversing the axis of the folded frame.
    pub(super) fn switch_rim(&mut self) {
        self.toss.switch_rim();
        self.toss.motion.cos = -self.toss.motion.cos;
        self.place.align(-1.0, 0.0);
        self.tracks.switch();
    }

    /// Moves the place by half of the way that `motion` makes in `time`.
    pub(super) fn half_way(&mut self, time: f64) {
        let (motion, turn) = (
            &self.toss.motion,
            -self.toss.spin.turn / self.toss.motion.sin,
        );
        let (sin, cos) = crate::series::sin_cos(0.5 * turn * time);
        let (dx, dy) = (0.5 * motion.vx * time, 0.5 * motion.vy * time);
        self.place.shift(dx, dy);
        self.place.align(cos, sin);
    }

    /// What follows once the own rim is clear of the ground: a high flight, or a low hop.
    pub(super) fn rise(&mut self) -> Next {
        /// A flight that rises by more than this many σ and goes farther than this many ℓ lands on
        /// other ground.
        const HIGH: f64 = 2.0;
        const FAR: f64 = 2.0;
        /// A rim that separates more slowly does so by its acceleration alone.
        const BY_ACCELERATION: f64 = 1e-9;
        self.give_back_lead();
        let [own, _] = rim_points(self.body(), &self.toss.motion, &self.toss.spin);
        let speed = -self.approach() - self.tracks.own.rate;
        let departure = if speed > BY_ACCELERATION {
            Departure::Rebound
        } else {
            Departure::LiftOff
        };
        let apex = 0.5 * speed * speed;
        let way = 2.0 * speed * own.speed();
        let high = apex > HIGH * self.ground.height && way > FAR * self.ground.length;
        if high || self.is_clear() {
            return Next::Ends(Transition::Flight(departure));
        }
        Next::Goes(Touch::Nothing)
    }

    /// Leaves the rough ground: the height is that above the own track again, and the axis of the
    /// folded frame points up.
    fn leave(&mut self) {
        if self.toss.motion.cos < 0.0 {
            self.switch_rim();
        }
        let motion = &mut self.toss.motion;
        let rest = motion.rest_height(&self.model.dynamics.body);
        let height = (motion.z - self.tracks.own.height).max(rest);
        let lowered = motion.z - height;
        motion.z = height;
        self.toss.place.lower_datum(-lowered);
    }
}

#[cfg(test)]
mod tests;

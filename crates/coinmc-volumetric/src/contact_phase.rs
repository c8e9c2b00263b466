//! A toss in sustained contact: on one rim point, on its side, or on its face.

use crate::contact::{ContactSolver, Exit, SideExit};
use crate::flight::Departure;
use crate::model::Model;
use crate::motion::{FLAT, Spin};
use crate::slide::{pulled_way_and_time, way_and_time};
use crate::toss::Toss;
use crate::transition::Transition;
use coinmc_core::{Decided, Ended, EventKind, Observer};

impl<L> Model<L> {
    /// Follows sustained contact of the lowest point to its end.
    pub(crate) fn follow_contact<O: Observer>(
        &self,
        toss: &mut Toss,
        solver: &mut ContactSolver<'_>,
        observer: &mut O,
    ) -> Transition {
        self.note_contact(toss);
        let (motion, spin, mut adapter) = toss.observed(&self.units, observer);
        let exit = match &self.pull {
            None => solver.follow(motion, spin, &mut adapter),
            Some(pull) => solver.follow_pulled(pull, motion, spin, &mut adapter),
        };
        if exit == Exit::LiftOff {
            self.notify(toss, EventKind::LiftOff, observer);
        }
        self.after_contact(toss, exit)
    }

    /// What follows sustained contact.
    pub(crate) fn after_contact(&self, toss: &mut Toss, exit: Exit) -> Transition {
        match exit {
            Exit::LiftOff => Transition::Flight(Departure::LiftOff),
            // rough ground: the other rim is near it; and the rule for a plane decides faces only
            Exit::OtherRim | Exit::Decided(Decided::Side) if self.ground.is_some() => {
                Transition::NearGround
            }
            Exit::OtherRim => {
                toss.motion.lay_on_side();
                toss.switch_rim();
                Transition::Impact
            }
            Exit::Level => Transition::Impact,
            Exit::Decided(decided) => Transition::End(toss.ended(decided)),
            Exit::NeverSettles => Transition::End(Ended::NeverSettles),
            Exit::TimeLimit => Transition::End(Ended::TimeLimit),
            Exit::GivenUp => Transition::End(self.end_given_up(toss)),
        }
    }

    /// Whether the coin rocks on its side so little that it may be laid down: gap, speed and
    /// angular velocity are below a tenth of zeno of half its thickness.
    #[inline]
    pub(crate) fn barely_rocks_on_side(&self, toss: &Toss) -> bool {
        let m = &toss.motion;
        let small = self.negligible_rocking * self.dynamics.body.half;
        m.vz.abs() < small && m.cos < small && toss.spin.tilt.abs() < small
    }

    /// Lays the coin on its side, and follows contact of both rims to its end.
    pub(crate) fn lie_on_side<O: Observer>(
        &self,
        toss: &mut Toss,
        solver: &mut ContactSolver<'_>,
        observer: &mut O,
    ) -> Transition {
        self.note_contact(toss);
        let (motion, spin, mut adapter) = toss.observed(&self.units, observer);
        let exit = match &self.pull {
            None => solver.follow_on_side(motion, spin, &mut adapter),
            Some(pull) => solver.follow_on_side_pulled(pull, motion, spin, &mut adapter),
        };
        match exit {
            SideExit::TipsOntoThisRim => Transition::Contact,
            SideExit::TipsOntoOtherRim => {
                toss.switch_rim();
                Transition::Contact
            }
            SideExit::Leaves(exit) => self.after_contact(toss, exit),
        }
    }

    /// Whether the coin stands on its face, apart from negligible rocking.
    pub(crate) fn stands_on_face(&self, toss: &Toss) -> bool {
        let m = &toss.motion;
        let small = self.negligible_rocking * self.dynamics.body.radius;
        m.sin < small
            && m.vz.abs() < small
            && toss.spin.tilt.abs() < small
            && toss.spin.turn.abs() < small
    }

    /// What follows for a coin that stands on its face and slides.
    ///
    /// Friction at the leading rim point tips it if μ n_x h > R, where n is the direction of slip
    /// there. Otherwise the face counts as decided. That is rigorous for μh <= R, and nearly so
    /// beyond: n_x may still grow while sliding and spinning die away together.
    pub(crate) fn tip_over_or_decide(&self, toss: &mut Toss) -> Transition {
        let body = &self.dynamics.body;
        let m = &mut toss.motion;
        let speed = (m.vx * m.vx + m.vy * m.vy).sqrt();
        let turning = body.radius * toss.spin.axial;
        let slip = (speed * speed + turning * turning).sqrt();
        if self.dynamics.friction.mu * speed * (body.half + body.rim) <= body.radius * slip {
            if self.rule.awaits_rest() {
                self.slide_to_rest(toss);
            }
            return Transition::End(Ended::Decided(toss.face()));
        }
        let before = m.energy(body, &toss.spin);
        let (nx, ny) = (m.vx / speed, m.vy / speed);
        m.align(nx, ny);
        // a first tilt, which raises the centre by no more than its own size
        m.set_tilt(FLAT, 1.0);
        (m.vz, m.z) = (0.0, m.rest_height(body));
        (toss.spin.tilt, toss.spin.turn) = (0.0, 0.0);
        m.cap_energy(body, &mut toss.spin, before);
        m.set_spin(&toss.spin, self.dynamics.axial_factor);
        toss.place.align(nx, ny);
        Transition::Contact
    }

    /// Slides a coin that stays flat on its face to where it rests.
    fn slide_to_rest(&self, toss: &mut Toss) {
        let (body, m) = (&self.dynamics.body, &mut toss.motion);
        let speed = (m.vx * m.vx + m.vy * m.vy).sqrt();
        let turning = body.radius * toss.spin.axial;
        let mu = self.dynamics.friction.mu;
        let (way, time) = if let Some(pull) = &self.pull {
            let pull = pull.in_frame(&toss.place, 0.0);
            pulled_way_and_time(body, mu, [m.vx, m.vy], turning, pull)
        } else {
            let (way, time) = way_and_time(body, mu, speed, turning);
            let along = |v: f64| if speed > 0.0 { way * v / speed } else { 0.0 };
            ([along(m.vx), along(m.vy)], time)
        };
        toss.place.shift(way[0], way[1]);
        toss.place.time += time;
        (m.vx, m.vy, m.vz) = (0.0, 0.0, 0.0);
        toss.spin = Spin::still();
        m.set_spin(&toss.spin, self.dynamics.axial_factor);
    }
}

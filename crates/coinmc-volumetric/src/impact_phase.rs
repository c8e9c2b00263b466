//! A toss at an impact: the bounce, and what follows it.

use crate::contact::ContactSolver;
use crate::flight::Departure;
use crate::impact::ImpactLaw;
use crate::model::Model;
use crate::rough::FLATTEST;
use crate::toss::Toss;
use crate::transition::Transition;
use coinmc_core::{Ended, EventKind, Observer};

/// A coin whose impacts change more often than this from one rim to the other, without flight,
/// is laid on its side.
pub(crate) const MAX_RIM_CHANGES: u32 = 100;
/// Speeds whose difference is below this fraction of them are equal apart from rounding.
const ROUNDING: f64 = 1e-13;

impl<L: ImpactLaw> Model<L> {
    /// One impact of the lowest point.
    pub(crate) fn impact<O: Observer>(
        &self,
        toss: &mut Toss,
        solver: &mut ContactSolver<'_>,
        observer: &mut O,
    ) -> Transition {
        if let Some(ground) = &self.ground
            && toss.motion.sin >= FLATTEST
        {
            return self.land_on(ground, toss, &mut solver.usage, observer);
        }
        if self.limits.no_impact_left(toss.impacts) {
            return Transition::End(Ended::ImpactLimit);
        }
        toss.impacts += 1;
        toss.face_approaching_point(self.dynamics.axial_factor);
        self.notify(toss, EventKind::Touching, observer);
        let mut bounced = self.bounce(&toss.motion, &toss.spin, true);
        if bounced.retry {
            bounced = self.bounce(&toss.motion, &toss.spin, false);
        }
        (toss.motion, toss.spin) = (bounced.motion, bounced.spin);
        self.notify(toss, EventKind::Impact, observer);
        if let Some(ended) = self.end_if_decided(toss) {
            return Transition::End(ended);
        }
        let next = after_bounce(bounced.stays, bounced.lifts_off);
        self.after_impact(toss, next, solver, observer)
    }

    /// What follows an impact after which the face is not decided: `next`, unless the coin comes to
    /// lie on its side, to stand on its face, or touches with another rim point at once.
    #[inline]
    pub(crate) fn after_impact<O: Observer>(
        &self,
        toss: &mut Toss,
        next: Transition,
        solver: &mut ContactSolver<'_>,
        observer: &mut O,
    ) -> Transition {
        if self.barely_rocks_on_side(toss) || toss.rim_changes > MAX_RIM_CHANGES {
            toss.rim_changes = 0;
            self.lie_on_side(toss, solver, observer)
        } else if self.stands_on_face(toss) {
            toss.rim_changes = 0;
            self.tip_over_or_decide(toss)
        } else if self.other_rim_approaches(toss) {
            toss.switch_rim();
            toss.rim_changes += 1;
            Transition::Impact
        } else if self.opposite_point_approaches(toss) {
            Transition::Impact
        } else {
            toss.rim_changes = 0;
            next
        }
    }

    /// Whether the coin is exactly on its side, and its other rim approaches the surface.
    fn other_rim_approaches(&self, toss: &Toss) -> bool {
        let m = &toss.motion;
        m.cos == 0.0 && approaches(m.vz, toss.spin.tilt * self.dynamics.body.half)
    }

    /// Whether the coin is level, and another point of its lower rim approaches the surface.
    pub(crate) fn opposite_point_approaches(&self, toss: &mut Toss) -> bool {
        let dynamics = &self.dynamics;
        toss.face_approaching_point(dynamics.axial_factor) && {
            let (vz, tilt) = (toss.motion.vz, toss.spin.tilt);
            let point = toss.motion.contact_point(&dynamics.body, &toss.spin);
            approaches(vz, vz - point.approach) && tilt > 0.0
        }
    }
}

/// What follows a bounce of an undecided coin that neither lies nor stands.
#[inline]
pub(crate) fn after_bounce(stays: bool, lifts_off: bool) -> Transition {
    if stays {
        Transition::Contact
    } else if lifts_off {
        Transition::Flight(Departure::LiftOff)
    } else {
        Transition::Flight(Departure::Rebound)
    }
}

/// Whether a point approaches the surface, by more than rounding, if it sinks at `down` relative to
/// the centre and the centre rises at `up`.
pub(crate) fn approaches(up: f64, down: f64) -> bool {
    up - down < -ROUNDING * (up.abs() + down.abs())
}

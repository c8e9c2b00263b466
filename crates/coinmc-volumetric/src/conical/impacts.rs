//! Impacts of a coin with a conical edge, and what follows them.

use super::Conical;
use super::on_edge::FromRim;
use crate::contact::Usage;
use crate::impact::ImpactLaw;
use crate::impact_phase::{MAX_RIM_CHANGES, after_bounce, approaches};
use crate::toss::Toss;
use crate::transition::Transition;
use coinmc_core::{Ended, EventKind, Observer};

impl<L: ImpactLaw> Conical<L> {
    /// One impact of the lowest point.
    pub(super) fn impact<O: Observer>(
        &self,
        toss: &mut Toss,
        usage: &mut Usage,
        observer: &mut O,
    ) -> Transition {
        let model = self.model(toss);
        if model.limits.no_impact_left(toss.impacts) {
            return Transition::End(Ended::ImpactLimit);
        }
        toss.impacts += 1;
        toss.face_approaching_point(model.dynamics.axial_factor);
        self.notify(toss, EventKind::Touching, observer);
        let mut bounced = model.bounce(&toss.motion, &toss.spin, true);
        if bounced.retry {
            bounced = model.bounce(&toss.motion, &toss.spin, false);
        }
        (toss.motion, toss.spin) = (bounced.motion, bounced.spin);
        self.notify(toss, EventKind::Impact, observer);
        if let Some(ended) = model.end_if_decided(toss) {
            return Transition::End(ended);
        }
        let next = after_bounce(bounced.stays, bounced.lifts_off);
        self.after_impact(toss, next, usage, observer)
    }

    /// What follows an impact after which the face is not decided: `next`, unless the coin comes to lie on
    /// its edge, to stand on its face, or touches with another rim point at once.
    fn after_impact<O: Observer>(
        &self,
        toss: &mut Toss,
        next: Transition,
        usage: &mut Usage,
        observer: &mut O,
    ) -> Transition {
        let model = self.model(toss);
        if self.barely_rocks(toss) || toss.rim_changes > MAX_RIM_CHANGES {
            toss.rim_changes = 0;
            self.lie_on_edge(toss, usage, FromRim::Rocking, observer)
        } else if model.stands_on_face(toss) {
            toss.rim_changes = 0;
            model.tip_over_or_decide(toss)
        } else if self.other_rim_approaches(toss) {
            toss.turn_over();
            toss.rim_changes += 1;
            Transition::Impact
        } else if model.opposite_point_approaches(toss) {
            Transition::Impact
        } else {
            toss.rim_changes = 0;
            next
        }
    }

    /// Whether the coin rocks on its edge so little that it may be laid down.
    fn barely_rocks(&self, toss: &Toss) -> bool {
        let (m, edge) = (&toss.motion, self.edge(toss));
        let small = self.model(toss).negligible_rocking * edge.shorter_reach();
        m.vz.abs() < small && (m.cos - edge.cos).abs() < small && toss.spin.tilt.abs() < small
    }

    /// Whether the coin is exactly on its edge, and its other rim approaches the surface.
    fn other_rim_approaches(&self, toss: &Toss) -> bool {
        let (m, edge) = (&toss.motion, self.edge(toss));
        m.cos == edge.cos && approaches(m.vz, toss.spin.tilt * edge.reach[1])
    }
}

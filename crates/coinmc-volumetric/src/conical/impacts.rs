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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conical::tests::{conical, launch};
    use crate::laws::Moreau;
    use crate::motion::Spin;
    use coinmc_testkit::Dice;

    /// A toss on its edge, on the rim of tails, that moves like this.
    fn on_edge(conical: &Conical<Moreau>, vz: f64, tilt_rate: f64) -> Toss {
        let mut toss = conical.launch(&launch(&mut Dice::new(80, 0)));
        if !toss.heads_up {
            toss.turn_over();
        }
        conical.touch_with_edge(&mut toss);
        toss.motion.vz = vz;
        toss.spin = Spin {
            axial: 0.0,
            turn: 0.0,
            tilt: tilt_rate,
        };
        toss
    }

    /// Its other rim strikes next if it sinks there, and the change is counted; after too many the coin is laid down.
    #[test]
    fn changes_of_rim_are_counted_until_the_coin_is_laid_down() {
        let conical = conical();
        let mut usage = Usage::default();
        // so that the other rim sinks at the speed 1
        let tilt_rate = 1.5 / conical.edges[0].reach[1];
        for counted in [0, 1, MAX_RIM_CHANGES] {
            let mut toss = on_edge(&conical, 0.5, tilt_rate);
            toss.rim_changes = counted;
            let before = toss.heads_up;
            let next = conical.after_impact(&mut toss, Transition::Contact, &mut usage, &mut ());
            assert_eq!(next, Transition::Impact);
            assert_eq!((toss.rim_changes, toss.heads_up), (counted + 1, !before));
        }
        for counted in [MAX_RIM_CHANGES + 1, MAX_RIM_CHANGES + 2] {
            let mut toss = on_edge(&conical, 0.5, tilt_rate);
            toss.rim_changes = counted;
            let next = conical.after_impact(&mut toss, Transition::Impact, &mut usage, &mut ());
            assert!(!matches!(next, Transition::Impact), "{counted}");
            assert_eq!(toss.rim_changes, 0);
        }
    }

    /// Only a coin that is near its edge and hardly moves up, down or over barely rocks.
    #[test]
    fn each_motion_alone_is_rocking() {
        let conical = conical();
        assert!(conical.barely_rocks(&on_edge(&conical, 0.0, 0.0)));
        assert!(!conical.barely_rocks(&on_edge(&conical, 0.1, 0.0)));
        assert!(!conical.barely_rocks(&on_edge(&conical, 0.0, 0.1)));
        let mut leans = on_edge(&conical, 0.0, 0.0);
        leans.motion.set_tilt(0.8, 0.6);
        assert!(!conical.barely_rocks(&leans));
    }
}

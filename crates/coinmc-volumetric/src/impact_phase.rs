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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::Spin;
    use crate::toss::tests::{generic_scene, model_of};
    use coinmc_core::Launch;
    use nalgebra::{UnitVector3, Vector3};

    fn still(axis: Vector3<f64>) -> Launch {
        Launch {
            height_m: 0.0,
            velocity_m_s: Vector3::zeros(),
            axis: UnitVector3::new_normalize(axis),
            spin_rad_s: Vector3::zeros(),
        }
    }

    /// A point sinks where it goes down faster than the centre goes up, by more than both are rounded.
    #[test]
    fn a_point_approaches_that_sinks_by_more_than_rounding() {
        assert!(approaches(0.3, 0.4) && approaches(-0.3, -0.2) && approaches(-0.1, 0.2));
        assert!(!approaches(0.4, 0.3) && !approaches(-0.2, -0.3) && !approaches(0.3, 0.3));
        // differences of 1e-12 and 1e-14 of the speeds
        assert!(approaches(0.3, 0.3 * (1.0 + 1e-12)) && !approaches(0.3, 0.3 * (1.0 + 1e-14)));
        // of slow ones, too
        assert!(approaches(3e-4, 3e-4 * (1.0 + 1e-12)) && !approaches(3e-4, 3e-4 * (1.0 + 1e-14)));
        // added, these speeds cancel: it is their size that counts
        assert!(approaches(-0.3, -0.3 * (1.0 - 1e-12)) && !approaches(-0.3, -0.3 * (1.0 - 1e-14)));
    }

    /// The other rim of a coin exactly on its side is h from the centre, and sinks at h ω relative to it.
    #[test]
    fn the_other_rim_of_a_coin_on_its_side_approaches_as_the_coin_tilts() {
        let model = model_of(
            &generic_scene(|surface| surface),
            &crate::settings::Settings::default(),
        );
        let half = model.dynamics.body.half;
        let mut toss = model.launch(&still(Vector3::x()));
        toss.motion.cos = 0.0;
        for (tilt, rises, approaches) in [
            (2.0, 1.9 * half, true),
            (2.0, 2.1 * half, false),
            (-2.0, -1.9 * half, false),
            (-2.0, -2.1 * half, true),
        ] {
            toss.spin = Spin {
                tilt,
                ..Spin::still()
            };
            toss.motion.vz = rises;
            assert_eq!(
                model.other_rim_approaches(&toss),
                approaches,
                "{tilt} {rises}"
            );
        }
        toss.motion.cos = 0.1;
        assert!(!model.other_rim_approaches(&toss));
    }

    /// If it does, it strikes next, and the change is counted; after too many the coin is laid down.
    #[test]
    fn changes_of_rim_are_counted_until_the_coin_is_laid_down() {
        let model = model_of(
            &generic_scene(|surface| surface),
            &crate::settings::Settings::default(),
        );
        for counted in [
            0,
            1,
            MAX_RIM_CHANGES,
            MAX_RIM_CHANGES + 1,
            2 * MAX_RIM_CHANGES,
        ] {
            let mut toss = model.launch(&still(Vector3::x()));
            toss.motion.cos = 0.0;
            toss.motion.vz = 0.5 * model.dynamics.body.half;
            toss.spin = Spin {
                tilt: 1.0,
                ..Spin::still()
            };
            toss.rim_changes = counted;
            let mut solver = model.contact_solver(crate::contact::Usage::default());
            let next = model.after_impact(&mut toss, Transition::Contact, &mut solver, &mut ());
            if counted <= MAX_RIM_CHANGES {
                assert_eq!((next, toss.rim_changes), (Transition::Impact, counted + 1));
            } else {
                assert_ne!(next, Transition::Impact);
                assert_eq!(toss.rim_changes, 0);
            }
        }
    }

    /// Of a level coin the point of its rim sinks fastest towards which it tilts, at R ω relative to the centre.
    #[test]
    fn the_lowest_going_point_of_a_level_coin_approaches_as_the_coin_tilts() {
        let model = model_of(
            &generic_scene(|surface| surface),
            &crate::settings::Settings::default(),
        );
        let (radius, factor) = (model.dynamics.body.radius, model.dynamics.axial_factor);
        for (tilt, rises, approaches) in [
            (2.0, 1.9 * radius, true),
            (2.0, 2.1 * radius, false),
            (-2.0, 1.9 * radius, true),
            (-2.0, 2.1 * radius, false),
            (0.0, -0.3, false),
        ] {
            let mut toss = model.launch(&still(Vector3::z()));
            toss.motion.set_tilt(0.0, 1.0);
            toss.spin = Spin {
                tilt,
                ..Spin::still()
            };
            toss.motion.set_spin(&toss.spin, factor);
            toss.motion.vz = rises;
            assert_eq!(
                model.opposite_point_approaches(&mut toss),
                approaches,
                "{tilt} {rises}"
            );
        }
        let mut leaning = model.launch(&still(Vector3::new(0.3, 0.0, 1.0)));
        leaning.motion.vz = -1.0;
        assert!(!model.opposite_point_approaches(&mut leaning));
    }
}

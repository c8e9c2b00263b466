//! How a toss ends outside sustained contact: at its launch, where it lands, or given up.
//!
//! Adhesive landing and the order of the checks are stated here once, for the scalar path and the
//! batch.

use crate::model::Model;
use crate::toss::Toss;
use coinmc_core::{Decided, Ended, Launch};

impl<L> Model<L> {
    /// The end of a toss whose face is decided by its motion now.
    #[inline]
    pub(crate) fn end_if_decided(&self, toss: &Toss) -> Option<Ended> {
        let (motion, body) = (&toss.motion, &self.dynamics.body);
        let decided = self.rule.decide(&motion.decision_state(body, &toss.spin));
        (decided != Decided::Open).then(|| toss.ended(decided))
    }

    /// The end of a toss that needs no simulation at all.
    pub(crate) fn end_at_launch(&self, toss: &Toss, launch: &Launch) -> Option<Ended> {
        let energy = toss.motion.energy(&self.dynamics.body, &toss.spin);
        if !(energy.is_finite() && is_finite(launch)) {
            Some(Ended::Failed)
        } else if self.adhesive || self.ground.is_some() {
            None
        } else {
            self.end_if_decided(toss)
                .or_else(|| self.conserves.then_some(Ended::NeverSettles))
        }
    }

    /// The end of a toss that has just landed, `time` after its launch: too late, or on a surface
    /// to which the coin sticks.
    #[inline]
    pub(crate) fn end_at_landing(&self, toss: &Toss, time: f64) -> Option<Ended> {
        if self.limits.is_late(time) {
            Some(Ended::TimeLimit)
        } else if self.adhesive {
            Some(toss.ended(self.rule.well(toss.motion.cos)))
        } else {
            None
        }
    }

    /// The end of a toss that is given up. If its state is still finite, some work limit was
    /// reached; every such limit is counted as the limit of impacts.
    pub(crate) fn end_given_up(&self, toss: &Toss) -> Ended {
        let energy = toss.motion.energy(&self.dynamics.body, &toss.spin);
        if energy.is_finite() {
            Ended::ImpactLimit
        } else {
            Ended::Failed
        }
    }
}

/// Whether all numbers of a launch are finite. (The energy need not show it: comparisons such as
/// `max` drop a NaN.)
fn is_finite(launch: &Launch) -> bool {
    let vectors = [
        launch.velocity_m_s,
        launch.axis.into_inner(),
        launch.spin_rad_s,
    ];
    launch.height_m.is_finite() && vectors.iter().flatten().all(|x| x.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::toss::tests::{launch, model};
    use coinmc_testkit::Dice;

    /// A toss fails if a number of its launch is not finite, or if its launch is so fast that its energy is not.
    #[test]
    fn a_launch_without_finite_numbers_or_energy_fails() {
        let model = model();
        let fails = |spoil: fn(&mut Launch)| {
            let mut launch = launch(&mut Dice::new(556, 0), None);
            spoil(&mut launch);
            model.end_at_launch(&model.launch(&launch), &launch) == Some(Ended::Failed)
        };
        assert!(!fails(|_| ()));
        let wrong: [fn(&mut Launch); 5] = [
            |launch| launch.height_m = f64::NAN,
            |launch| launch.height_m = f64::INFINITY,
            |launch| launch.velocity_m_s.y = f64::NEG_INFINITY,
            |launch| launch.velocity_m_s.x = 1e200,
            |launch| launch.spin_rad_s.z = 1e200,
        ];
        for spoil in wrong {
            assert!(fails(spoil));
        }
    }
}

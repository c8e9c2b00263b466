//! The energy of a coin on rough ground, and how its velocities follow it.

use super::walk::Walk;
use crate::impact::ImpactLaw;
use coinmc_core::Observer;

impl<I: ImpactLaw, O: Observer> Walk<'_, I, O> {
    /// Mechanical energy per m g D, the potential zero at the mean of the ground.
    pub(super) fn energy(&self) -> f64 {
        self.toss.motion.energy(self.body(), &self.toss.spin)
    }

    /// Scales the velocities relative to the own track so that the energy is the budget.
    ///
    /// The tracks stand for a ground at rest, whose forces on a rim that rolls do no work. But a
    /// vertical force on a rim whose track rises works, since the force of a slope that would slow
    /// down the coin is left out. So what a coin gains by climbing a slope is taken from all its
    /// velocities, and what it gives back on the way down is returned.
    ///
    /// With v the velocities relative to the track, which rises at p, and k the scale,
    /// T(k) = T(v) k² + v_z p k + p²/2 is to be the budget less the potential energy. Where no k
    /// does that, the slope is too high for the coin: it comes to rest where its energy ends.
    pub(super) fn balance(&mut self) {
        /// A coin almost at rest would otherwise turn slopes into rocking.
        const LARGEST: f64 = 1.1;
        let rate = self.tracks.own.rate;
        let mut motion = self.relative_motion();
        let kinetic = motion.kinetic(self.body(), &self.toss.spin);
        let wanted = self.budget + self.lead - self.toss.motion.z - 0.5 * rate * rate;
        let cross = motion.vz * rate;
        let discriminant = cross * cross + 4.0 * kinetic * wanted;
        let root = discriminant.max(0.0).sqrt() - cross;
        let scale = if discriminant < 0.0 || root <= 0.0 {
            self.tracks
                .stop(self.toss.motion.z - self.budget - self.lead);
            0.0
        } else {
            (root / (2.0 * kinetic)).min(LARGEST)
        };
        let mut spin = self.toss.spin;
        for rotation in [&mut spin.axial, &mut spin.turn, &mut spin.tilt] {
            *rotation *= scale;
        }
        for velocity in [&mut motion.vx, &mut motion.vy, &mut motion.vz] {
            *velocity *= scale;
        }
        motion.set_spin(&spin, self.model.dynamics.axial_factor);
        self.set_relative(motion, spin);
    }

    /// Takes back what slopes have given ahead, of a coin that leaves the ground.
    pub(super) fn give_back_lead(&mut self) {
        if self.lead != 0.0 {
            self.lead = 0.0;
            self.balance();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::test_scenes::Rough;
    use super::*;
    use crate::contact::Usage;
    use coinmc_core::Launch;
    use coinmc_testkit::Dice;
    use nalgebra::{UnitVector3, Vector3};

    /// After it the energy is the budget and the lead, with velocities relative to the track all
    /// scaled alike; unless the coin would speed up by more than a tenth, or its energy does not
    /// reach its height: then it is at rest, at the height at which its energy ends.
    #[test]
    fn velocities_follow_the_budget() {
        let model = Rough::of(0.5, 0.05).model();
        let ground = model.ground.expect("a rough ground");
        let mut seen = [0; 3];
        for toss in 0..400 {
            let mut dice = Dice::new(413, toss);
            let launch = Launch {
                height_m: 0.0,
                velocity_m_s: dice.vector(0.3),
                axis: UnitVector3::new_normalize(Vector3::new(1.0, 0.0, dice.between(0.0, 1.0))),
                spin_rad_s: dice.vector(10.0),
            };
            let mut toss = model.launch(&launch);
            let (mut usage, mut observer) = (Usage::default(), ());
            let mut walk =
                Walk::above_ground(&model, &ground, &mut toss, &mut usage, &mut observer);
            walk.tracks.own.rate = dice.between(-0.1, 0.1);
            walk.lead = dice.between(0.0, 0.05);
            let (before, energy) = (walk.relative_motion(), walk.energy());
            let axial = walk.toss.spin.axial;
            walk.budget = energy + dice.between(-0.3, 0.1);
            walk.balance();
            let after = walk.relative_motion();
            let scale = after.vx / before.vx;
            let left = walk.energy() - walk.budget - walk.lead;
            if scale == 0.0 {
                seen[0] += 1;
                assert_eq!(walk.tracks.own.rate, 0.0);
                assert!(left.abs() < 1e-12, "{left}");
            } else if (scale - 1.1).abs() < 1e-12 {
                seen[1] += 1;
                assert!(left < 1e-12, "{left}");
            } else {
                seen[2] += 1;
                assert!(scale < 1.1 && left.abs() < 1e-12, "{scale} {left}");
            }
            for (old, new) in [
                (before.vy, after.vy),
                (before.vz, after.vz),
                (axial, walk.toss.spin.axial),
            ] {
                assert!(
                    (new - scale * old).abs() < 1e-12 * (1.0 + old.abs()),
                    "{old} {new}"
                );
            }
        }
        assert!(seen.iter().all(|count| *count > 20), "{seen:?}");
    }
}

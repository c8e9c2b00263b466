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

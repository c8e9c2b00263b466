//! The impact of the lowest point, of one toss or of several side by side.

use crate::contact;
use crate::engine::VolumetricEngine;
use crate::impact::{ImpactLaw, Touch};
use crate::motion::{Motion, Spin};
use coinmc_lanes::{Lane, Mask};

/// The coin after an impact.
pub(crate) struct Struck<L: Lane> {
    pub(crate) motion: Motion<L>,
    pub(crate) spin: Spin<L>,
    /// Sustained contact follows; else flight.
    pub(crate) sustains: L::Mask,
    /// The contact point parts by its acceleration alone.
    pub(crate) parts: L::Mask,
    /// None of this: it was taken for the last bounce and is not, and has to be struck anew as
    /// certainly not the last.
    pub(crate) again: L::Mask,
}

impl<L: ImpactLaw> VolumetricEngine<L> {
    /// The impact of the lowest point, or, if the bounces that remain would all be over before the
    /// coin has turned noticeably, the end of them all at once. That is tried only where it
    /// `may_end`.
    #[inline(always)]
    pub(crate) fn strike<T: Lane>(
        &self,
        motion: &Motion<T>,
        spin: &Spin<T>,
        may_end: T::Mask,
    ) -> Struck<T> {
        let law = &self.contact;
        let (zero, one, two) = (T::splat(0.0), T::splat(1.0), T::splat(2.0));
        let energy = motion.energy(&law.body, spin);
        let mut touch = motion.touch(&law.body, spin);
        // a point that is swapped in may leave already, by rounding
        touch.approach = touch.approach.min(zero);
        let speed = -touch.approach;
        let slow = speed.lt(T::splat(self.threshold));
        let e = T::select(slow, zero, T::splat(self.restitution));
        let plastic = e.le(zero);
        // the bounces that remain take 2 e v/(a(1 − e)), a the acceleration that closes the gap
        let rest = two * e * speed;
        let quick = T::splat(self.settings.zeno) * (one - e);
        let short = rest.lt(quick * (two + two * law.uplift(motion, spin)));
        let tries = (may_end & short) | plastic;
        let e = T::select(tries, zero, e);
        let (mut motion, spin) = self.thrown_back(motion, spin, &touch, e, energy);
        let never = <T::Mask as Mask>::splat(false);
        let (mut sustains, mut parts, mut again) = (never, never, never);
        if tries.any() {
            let press = law.press(&motion, &spin);
            let over = (rest * contact::fastest(&motion, &spin)).lt(quick * press);
            sustains = tries & zero.lt(press) & over;
            parts = plastic & !sustains;
            again = tries & !sustains & !plastic;
        }
        motion.set_spin(&spin, law.axial_factor);
        Struck {
            motion,
            spin,
            sustains,
            parts,
            again,
        }
    }

    /// The motion after the impact with restitution `e`, with no more energy than `before`.
    #[inline(always)]
    fn thrown_back<T: Lane>(
        &self,
        motion: &Motion<T>,
        spin: &Spin<T>,
        touch: &Touch<T>,
        e: T,
        before: T,
    ) -> (Motion<T>, Spin<T>) {
        let law = &self.contact;
        let p = self.impact.impulse(&law.body, &law.friction, touch, e);
        let (mut motion, mut spin) = (*motion, *spin);
        motion.strike(&mut spin, &law.body, touch, p);
        motion.cap_energy(&law.body, &mut spin, before);
        (motion, spin)
    }
}

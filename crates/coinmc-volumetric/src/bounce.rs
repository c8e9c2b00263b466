//! One impact of the lowest point: an ordinary bounce, or the end of a sequence of bounces.
//! Generic over lanes: one toss or several at once.

use crate::contact::{self, Dynamics};
use crate::impact::{ContactPoint, ImpactLaw};
use crate::model::Model;
use crate::motion::{Motion, Spin};
use coinmc_lanes::{Lane, Mask};

/// The coin after an impact.
pub(crate) struct Bounced<L: Lane> {
    pub(crate) motion: Motion<L>,
    pub(crate) spin: Spin<L>,
    /// Sustained contact follows; otherwise flight.
    pub(crate) stays: L::Mask,
    /// The contact point separates by its acceleration alone.
    pub(crate) lifts_off: L::Mask,
    /// The impact was computed as the last bounce and turned out not to be. The rest of the result
    /// is not valid; the impact must be computed again with `may_be_last` off.
    pub(crate) retry: L::Mask,
}

impl<I: ImpactLaw> Model<I> {
    /// The impact of the lowest point.
    ///
    /// If all remaining bounces would be over before the coin has turned noticeably, they are
    /// replaced by one impact with e = 0 and sustained contact. This is tried only where
    /// `may_be_last` is set.
    #[inline(always)]
    pub(crate) fn bounce<L: Lane>(
        &self,
        motion: &Motion<L>,
        spin: &Spin<L>,
        may_be_last: L::Mask,
    ) -> Bounced<L> {
        let dynamics = &self.dynamics;
        // sharp rims, known to the compiler, take fewer operations
        if dynamics.body.rim == 0.0 {
            self.bounce_of(&dynamics.with_sharp_rims(), motion, spin, may_be_last)
        } else {
            self.bounce_of(dynamics, motion, spin, may_be_last)
        }
    }

    /// The same, with the dynamics as the compiler knows them.
    #[inline(always)]
    fn bounce_of<L: Lane>(
        &self,
        dynamics: &Dynamics,
        motion: &Motion<L>,
        spin: &Spin<L>,
        may_be_last: L::Mask,
    ) -> Bounced<L> {
        let (zero, one, two) = (L::splat(0.0), L::splat(1.0), L::splat(2.0));
        let energy = motion.energy(&dynamics.body, spin);
        let mut point = motion.contact_point(&dynamics.body, spin);
        // a rim point that has just become the lowest may already recede, by rounding
        point.approach = point.approach.min(zero);
        let speed = -point.approach;
        let most = self.restitution.most(speed);
        let plastic = most.le(zero);
        // the remaining bounces take 2 e v/(a(1 − e)) at most, where a is the acceleration that
        // closes the gap
        let rest = two * most * speed;
        let quick = L::splat(self.zeno) * (one - most);
        let short = rest.lt(quick * (two + two * dynamics.uplift(motion, spin)));
        let tries = (may_be_last & short) | plastic;
        let e = L::select(tries, zero, self.restitution.at(speed, most));
        let (mut motion, spin) = self.after_impulse(dynamics, motion, spin, &point, e, energy);
        let never = <L::Mask as Mask>::splat(false);
        let (mut stays, mut lifts_off, mut retry) = (never, never, never);
        if tries.any() {
            let press = dynamics.press(&motion, &spin);
            let over = (rest * contact::fastest_rate(&motion, &spin)).lt(quick * press);
            stays = tries & zero.lt(press) & over;
            lifts_off = plastic & !stays;
            retry = tries & !stays & !plastic;
        }
        motion.set_spin(&spin, dynamics.axial_factor);
        Bounced {
            motion,
            spin,
            stays,
            lifts_off,
            retry,
        }
    }

    /// The motion after the impact with restitution `e`, with no more energy than `energy`.
    #[inline(always)]
    fn after_impulse<L: Lane>(
        &self,
        dynamics: &Dynamics,
        motion: &Motion<L>,
        spin: &Spin<L>,
        point: &ContactPoint<L>,
        e: L,
        energy: L,
    ) -> (Motion<L>, Spin<L>) {
        let p = self
            .impact
            .impulse(&dynamics.body, &dynamics.friction, point, e);
        let (mut motion, mut spin) = (*motion, *spin);
        motion.apply_impulse(&mut spin, &dynamics.body, point, p);
        motion.cap_energy(&dynamics.body, &mut spin, energy);
        // rough ground turns its normal from impact to impact, so nothing stays in a plane there
        if self.ground.is_none() {
            motion.stop_residue(&mut spin);
        }
        (motion, spin)
    }
}

//! One toss in progress, from its launch.

use crate::counters::Counters;
use crate::decision::decided;
use crate::motion::Motion;
use crate::parameters::Parameters;
use coinmc_core::{Ended, Landing, Launch};

/// The state of one toss.
pub(crate) struct Toss {
    pub(crate) motion: Motion,
    pub(crate) counters: Counters,
}

impl<L> Parameters<L> {
    /// The toss at its launch.
    #[inline]
    pub(crate) fn launched(&self, launch: &Launch) -> Toss {
        Toss {
            motion: Motion::new(launch, &self.units, &self.shape),
            counters: Counters::default(),
        }
    }

    /// How the toss ends, if it ends at the launch: it is not finite, or its energy decides it.
    #[inline]
    pub(crate) fn ends_at_launch(&self, motion: &Motion, launch: &Launch) -> Option<Ended> {
        let energy = motion.energy(self.shape.k);
        if !(energy.is_finite() && launch.height_m.is_finite() && motion.delta.is_finite()) {
            return Some(Ended::Failed);
        }
        let decided_now = self.landing == Landing::Bouncing && self.contact.is_decided(motion);
        decided_now.then(|| decided(motion))
    }
}

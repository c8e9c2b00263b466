//! The limits at which a toss is given up as undecided: impacts, steps of contact, time.
//!
//! The scalar path and the batch both ask here. What depends on numbers that a batch holds in
//! lanes is generic over lanes.

use crate::settings::Settings;
use coinmc_lanes::Lane;

/// Shortest step of the contact integrator, in sqrt(D/g). If it needs a shorter one, the toss is
/// given up.
const SHORTEST_STEP: f64 = 1e-13;

#[derive(Debug, Clone, Copy)]
pub(crate) struct Limits {
    max_impacts: u32,
    max_steps: u32,
    time: f64,
}

impl Limits {
    pub(crate) fn new(settings: &Settings) -> Self {
        Self {
            max_impacts: settings.max_impacts,
            max_steps: settings.max_steps,
            time: settings.time_limit,
        }
    }

    /// Whether a toss with this many impacts may have no further one.
    #[inline]
    pub(crate) fn no_impact_left(&self, impacts: u32) -> bool {
        impacts == self.max_impacts
    }

    /// Whether a toss with this many steps of contact may have no further one.
    #[inline]
    pub(crate) fn no_step_left(&self, steps: u32) -> bool {
        steps >= self.max_steps
    }

    /// Whether a step of contact may be tried, given its `length` and its number within the toss.
    /// (The numbers of steps are whole numbers held as floats.)
    #[inline(always)]
    pub(crate) fn allow_step<L: Lane>(&self, length: L, number: L) -> L::Mask {
        let last = L::splat(f64::from(self.max_steps)).le(number);
        !(length.lt(L::splat(SHORTEST_STEP)) | last)
    }

    /// Whether the time limit has passed at `time` after the launch.
    #[inline(always)]
    pub(crate) fn is_late<L: Lane>(&self, time: L) -> L::Mask {
        L::splat(self.time).lt(time)
    }
}

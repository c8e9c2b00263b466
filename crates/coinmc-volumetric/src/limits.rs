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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::four::Four;

    /// As many impacts and steps as the settings allow, no shorter step than the shortest, and time up to its limit.
    #[test]
    fn limits_are_those_of_the_settings() {
        let limits = Limits::new(&Settings {
            max_impacts: 5,
            max_steps: 7,
            time_limit: 12.5,
            ..Settings::default()
        });
        let impacts = [0, 4, 5].map(|impacts| limits.no_impact_left(impacts));
        assert_eq!(impacts, [false, false, true]);
        let steps = [0, 6, 7, 8].map(|steps| limits.no_step_left(steps));
        assert_eq!(steps, [false, false, true, true]);
        let tried = limits.allow_step(Four([0.1, 0.1, 0.9e-13, 1.1e-13]), Four([6., 7., 1., 1.]));
        assert_eq!(tried.0, [true, false, false, true]);
        let late = limits.is_late(Four([0.0, 12.5, 12.6, f64::NAN]));
        assert_eq!(late.0, [false, false, true, false]);
    }
}

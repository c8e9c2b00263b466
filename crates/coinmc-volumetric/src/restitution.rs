//! The coefficient of restitution of an impact, given its speed of approach.

use crate::body::Units;
use coinmc_core::Surface;
use coinmc_lanes::{Lane, Mask};

/// Restitution; speeds in sqrt(g D).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Restitution {
    /// e up to the reference speed.
    nominal: f64,
    /// Approach speed below which e = 0.
    threshold: f64,
    /// e(v) = e (v/v_ref)^−p above the reference speed v_ref.
    exponent: f64,
    reference: f64,
}

impl Restitution {
    pub(crate) fn new(surface: &Surface, units: &Units) -> Self {
        Self {
            nominal: surface.restitution(),
            threshold: surface.restitution_threshold_m_s() / units.speed_m_s(),
            exponent: surface.restitution_exponent(),
            reference: surface.restitution_reference_m_s() / units.speed_m_s(),
        }
    }

    /// Restitution of an impact at this speed, and of any that follow it more slowly: e at most.
    #[inline(always)]
    pub(crate) fn most<L: Lane>(&self, speed: L) -> L {
        let slow = speed.lt(L::splat(self.threshold));
        L::select(slow, L::splat(0.0), L::splat(self.nominal))
    }

    /// Restitution of an impact at this speed, given [`most`](Self::most).
    #[inline(always)]
    pub(crate) fn at<L: Lane>(&self, speed: L, most: L) -> L {
        if self.exponent == 0.0 {
            return most;
        }
        let fast = L::splat(self.reference).lt(speed);
        if !fast.any() {
            return most;
        }
        let (reference, exponent) = (self.reference, self.exponent);
        let factor = speed.map_where(fast, |speed| libm::pow(speed / reference, -exponent));
        L::select(fast, most * factor, most)
    }

    /// Whether every impact has this restitution.
    pub(crate) fn is_constant(&self) -> bool {
        self.threshold == 0.0 && self.exponent == 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::toss::tests::generic_scene;
    use coinmc_core::Scene;

    fn restitution(threshold_m_s: f64, exponent: f64) -> (Restitution, f64) {
        let scene: Scene = generic_scene(|plane| {
            plane
                .with_restitution_threshold(threshold_m_s)
                .and_then(|plane| plane.with_speed_dependent_restitution(exponent, 0.2))
                .expect("a valid surface")
        });
        let unit_m_s = (9.81 * scene.coin.rim_distance_m()).sqrt();
        (
            Restitution::new(&scene.surface, &Units::new(&scene)),
            unit_m_s,
        )
    }

    /// Restitution is 0 below its threshold, e up to the reference speed, and falls with a power of the speed beyond.
    /// It is constant only without a threshold and without that power.
    #[test]
    fn restitution_is_that_of_the_speed_of_approach() {
        for (threshold, exponent) in [(0.0, 0.0), (0.05, 0.0), (0.0, 0.25), (0.05, 0.25)] {
            let (restitution, unit) = restitution(threshold, exponent);
            let constant = threshold == 0.0 && exponent == 0.0;
            assert_eq!(restitution.is_constant(), constant);
            for speed in [0.01, 0.04, 0.06, 0.19, 0.21, 0.8, 3.2] {
                let most = restitution.most(speed / unit);
                let expected = if speed < threshold {
                    0.0
                } else if speed > 0.2 {
                    0.5 * libm::pow(0.2 / speed, exponent)
                } else {
                    0.5
                };
                assert_eq!(most, if speed < threshold { 0.0 } else { 0.5 });
                let e = restitution.at(speed / unit, most);
                assert!((e - expected).abs() < 1e-15, "{speed}: {e} {expected}");
            }
        }
    }
}

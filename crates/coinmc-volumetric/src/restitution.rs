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

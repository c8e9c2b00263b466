//! A coin whose lowest corner is on the surface, and the effect of an impulse there: over lanes.

use crate::contact_matrix::{ContactMatrix, Impulse};
use crate::motion::{self, Motion};
use coinmc_lanes::{Lane, sin_cos};

/// Sine and cosine of the angle, and the velocities. The centre is cos δ above the surface.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Touching<L> {
    pub(crate) sin: L,
    pub(crate) cos: L,
    pub(crate) vx: L,
    pub(crate) vz: L,
    pub(crate) omega: L,
}

impl Touching<f64> {
    #[inline]
    pub(crate) fn of(motion: &Motion) -> Self {
        Self::new(motion.delta, motion.vx, motion.vz, motion.omega)
    }
}

impl<L: Lane> Touching<L> {
    #[inline(always)]
    pub(crate) fn new(delta: L, vx: L, vz: L, omega: L) -> Self {
        let (sin, cos) = sin_cos(delta);
        Self {
            sin,
            cos,
            vx,
            vz,
            omega,
        }
    }

    #[inline(always)]
    pub(crate) fn matrix(&self, k: f64) -> ContactMatrix<L> {
        ContactMatrix::new(self.sin, self.cos, k)
    }

    /// Velocity of the corner, whose normal part is at most zero.
    #[inline(always)]
    pub(crate) fn approach(&self) -> (L, L) {
        // a corner that has just become the lowest may already rise, by rounding
        let down = (self.vz + self.omega * self.sin).min(L::splat(0.0));
        (self.vx - self.omega * self.cos, down)
    }

    /// The angular velocity after an impulse.
    #[inline(always)]
    pub(crate) fn omega_after(&self, p: &Impulse<L>, k: f64) -> L {
        self.omega + (self.sin * p.z - self.cos * p.x) / L::splat(k)
    }

    /// The coin after an impulse.
    #[inline(always)]
    pub(crate) fn after(&self, p: &Impulse<L>, k: f64) -> Self {
        Self {
            vx: self.vx + p.x,
            vz: self.vz + p.z,
            omega: self.omega_after(p, k),
            ..*self
        }
    }

    #[inline(always)]
    pub(crate) fn energy_without_sliding(&self, k: f64) -> L {
        motion::energy_without_sliding(k, [self.cos, self.vz, self.omega])
    }

    #[inline(always)]
    pub(crate) fn energy(&self, k: f64) -> L {
        self.energy_without_sliding(k) + L::splat(0.5) * self.vx * self.vx
    }

    /// The same coin with no more energy than `before`: see [`Motion::cap_energy`].
    #[inline(always)]
    pub(crate) fn capped(self, k: f64, before: L) -> Self {
        motion::cap(self.cos, self.energy(k), before).map_or(self, |scale| Self {
            vx: self.vx * scale,
            vz: self.vz * scale,
            omega: self.omega * scale,
            ..self
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All velocities shrink by one factor, and the energy is then what it may be.
    #[test]
    fn a_coin_that_gained_energy_is_slowed_down_to_what_it_had() {
        let k = 0.3;
        let coin = Touching::new(0.4, 0.3, -0.2, 0.5);
        let before = coin.cos + 0.25 * (coin.energy(k) - coin.cos);
        let capped = coin.capped(k, before);
        for (now, then) in [
            (capped.vx, coin.vx),
            (capped.vz, coin.vz),
            (capped.omega, coin.omega),
        ] {
            assert!((now - 0.5 * then).abs() < 1e-15);
        }
        assert!((capped.energy(k) - before).abs() < 1e-15);
        let lossless = coin.capped(k, coin.energy(k));
        assert_eq!(
            [lossless.vx, lossless.vz, lossless.omega],
            [coin.vx, coin.vz, coin.omega]
        );
    }
}

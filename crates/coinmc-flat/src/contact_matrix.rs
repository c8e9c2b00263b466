//! The velocity of the touching corner and the impulse on it.
//!
//! Everything is per unit mass and in the xz plane. With r = (−sin δ, −cos δ) the corner relative
//! to the centre, an impulse p changes the velocity of the corner by K p,
//!
//! K_xx = 1 + r_z²/k,  K_zz = 1 + r_x²/k,  K_xz = −r_x r_z/k  (lengths in D, k = I/mD²).

use coinmc_lanes::Lane;

/// The contact's inverse mass matrix K.
#[derive(Debug, Clone, Copy)]
pub struct ContactMatrix<L = f64> {
    /// Horizontal velocity by horizontal impulse.
    pub xx: L,
    /// Horizontal velocity by normal impulse.
    pub xz: L,
    /// Normal velocity by normal impulse.
    pub zz: L,
}

impl<L: Lane> ContactMatrix<L> {
    /// K of a corner with the centre at angle δ beyond its balance, sin δ and cos δ given.
    #[inline(always)]
    pub fn new(sin: L, cos: L, k: f64) -> Self {
        let (one, k) = (L::splat(1.0), L::splat(k));
        Self {
            xx: one + cos * cos / k,
            xz: -sin * cos / k,
            zz: one + sin * sin / k,
        }
    }

    /// det K = 1 + 1/k: the corner is a distance 1 from the centre, whatever δ.
    #[inline(always)]
    fn determinant(self) -> L {
        self.xx * self.zz - self.xz * self.xz
    }

    /// The impulse that changes the contact velocity by (dx, dz).
    #[inline(always)]
    pub(crate) fn solve(self, dx: L, dz: L) -> (L, L) {
        let inverse = L::splat(1.0) / self.determinant();
        (
            (self.zz * dx - self.xz * dz) * inverse,
            (self.xx * dz - self.xz * dx) * inverse,
        )
    }
}

/// An impulse per unit mass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impulse<L: Lane = f64> {
    /// Horizontal part.
    pub x: L,
    /// Normal part, not negative.
    pub z: L,
    /// The contact point does not slide afterwards.
    pub sticks: L::Mask,
}

impl<L: Lane> Impulse<L> {
    #[inline(always)]
    pub(crate) fn select(mask: L::Mask, yes: Self, no: Self) -> Self {
        Self {
            x: L::select(mask, yes.x, no.x),
            z: L::select(mask, yes.z, no.z),
            sticks: (mask & yes.sticks) | (!mask & no.sticks),
        }
    }
}
